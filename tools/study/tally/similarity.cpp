// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/similarity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace hotfire::study {
namespace {

constexpr double kMostApart = 0.1;
constexpr double kNothing = 0.05;

std::multiset<std::string> finds(const Judgement& judgement) {
  std::multiset<std::string> names;
  for (std::size_t i = 0; i < judgement.found.size(); ++i) {
    names.insert(judgement.found[i] + (judgement.found_laws[i].empty() ? "" : ":" + judgement.found_laws[i]));
  }
  return names;
}

std::string text_of(const Judgement& judgement) {
  std::string errors;
  for (const auto& [channel, error] : judgement.after) {
    errors += fmt::format("{}{:.3f}", errors.empty() ? "" : "/", error);
  }
  const auto names = finds(judgement);
  return fmt::format("{} {} {:.1f} s{}", names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, " + ")), errors,
                     judgement.processor_seconds, judgement.failure.empty() ? "" : "; failed: " + judgement.failure);
}

}  // namespace

bool SimilarPair::same_names() const {
  return as_made.failure.empty() && small_and_fast.failure.empty() && as_made.verdict == small_and_fast.verdict &&
         finds(as_made) == finds(small_and_fast);
}

bool SimilarPair::same_errors() const {
  if (as_made.after.empty() || as_made.after.size() != small_and_fast.after.size()) {
    return false;
  }
  return std::all_of(as_made.after.begin(), as_made.after.end(), [&](const auto& entry) {
    const double one = entry.second;
    const double other = small_and_fast.after.at(entry.first);
    const double larger = std::max(one, other);
    return larger < kNothing || std::abs(one - other) <= kMostApart * larger;
  });
}

SimilarPair judge_similar(const std::filesystem::path& folder, unsigned threads) {
  return {judge(folder, threads), judge(folder, threads, kSmallAndFast)};
}

std::string line_of(const SimilarPair& pair) {
  return fmt::format("{:<24} {} {}  as made: {}  small and fast: {}", pair.as_made.name,
                     pair.same_names() ? "names" : "NAMES", pair.same_errors() ? "errors" : "ERRORS", text_of(pair.as_made),
                     text_of(pair.small_and_fast));
}

nlohmann::json json_of(const SimilarPair& pair) {
  return {{"case", pair.as_made.name},
          {"same_names", pair.same_names()},
          {"same_errors", pair.same_errors()},
          {"as_made", json_of(pair.as_made)},
          {"small_and_fast", json_of(pair.small_and_fast)}};
}

std::string summary_of(const std::vector<SimilarPair>& pairs) {
  const auto names = std::count_if(pairs.begin(), pairs.end(), [](const SimilarPair& p) { return p.same_names(); });
  const auto errors = std::count_if(pairs.begin(), pairs.end(), [](const SimilarPair& p) { return p.same_errors(); });
  const auto all = std::ssize(pairs);
  return fmt::format("{:<44} {} of {}, asked all: {}\n{:<44} {} of {}, asked all: {}\n", "similarity: the same names", names,
                     all, names == all ? "met" : "NOT MET", "similarity: errors equal within 10 %", errors, all,
                     errors == all ? "met" : "NOT MET");
}

bool all_met(const std::vector<SimilarPair>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(),
                     [](const SimilarPair& pair) { return pair.same_names() && pair.same_errors(); });
}

}  // namespace hotfire::study
