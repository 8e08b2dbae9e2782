// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/suggestion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace hotfire {

namespace {

/// Levenshtein distance: insertions, deletions and replacements that turn one word into the other.
std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string lower(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return small;
}

}  // namespace

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& known) {
  std::string_view nearest;
  std::size_t smallest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    // The distance is at least the difference of the lengths. Without this bound a long wrong word takes most of the time
    // that its file takes.
    if (std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size()) >= smallest) {
      continue;
    }
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < smallest && distance < candidate.size()) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::vector<std::string_view> nearest_words(std::string_view word, const std::vector<std::string_view>& known,
                                            std::size_t most) {
  const std::string wanted = lower(word);
  std::vector<std::pair<std::size_t, std::string_view>> words;
  words.reserve(known.size());
  for (const std::string_view candidate : known) {
    words.emplace_back(edit_distance(wanted, lower(candidate)), candidate);
  }
  std::sort(words.begin(), words.end());
  std::vector<std::string_view> nearest;
  for (std::size_t i = 0; i < std::min(most, words.size()); ++i) {
    nearest.push_back(words[i].second);
  }
  return nearest;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearest_word(word, known);
  const std::string allowed = fmt::format("allowed: {}", fmt::join(known, ", "));
  return nearest.empty() ? allowed : fmt::format("did you mean \"{}\"? {}", nearest, allowed);
}

}  // namespace hotfire
