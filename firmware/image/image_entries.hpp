// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "firmware/text/text.hpp"
#include "model/checks.hpp"

namespace hotfire::firmware {

/// A line of an image.
struct Entry {
  std::string key;
  std::string value;
  int line;
  bool used = false;
};

/// The lines of an image, each to be used once, and the first error that was found in them.
class Entries {
 public:
  Entries(const std::string& text, const std::string& name) : name_(name) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      add(line, number);
    }
  }

  const std::string& error() const { return error_; }

  void refuse(const std::string& what) {
    if (error_.empty()) {
      error_ = name_ + ": " + what;
    }
  }

  void refuse(const Entry& entry, const std::string& allowed) {
    refuse(text("line %d: %s = %.60s: %s", entry.line, entry.key.c_str(), entry.value.c_str(), allowed.c_str()));
  }

  bool has(const std::string& key) { return find(key) != nullptr; }

  bool has_prefix(std::string_view prefix) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key.starts_with(prefix); });
  }

  /// The entry of a required key; null after a refusal.
  const Entry* take(const std::string& key) {
    Entry* entry = find(key);
    if (entry == nullptr) {
      refuse("missing key " + key);
    } else {
      entry->used = true;
    }
    return entry;
  }

  void refuse_unused() {
    for (const Entry& entry : entries_) {
      if (!entry.used) {
        refuse(entry, "unknown key for this topology, law or channel");
      }
    }
  }

 private:
  void add(const std::string& line, int number) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos || space == 0 || line.find(' ', space + 1) != std::string::npos) {
      refuse(text("line %d: \"%.60s\": expected `key value`, one space between them", number, line.c_str()));
      return;
    }
    Entry entry{line.substr(0, space), line.substr(space + 1), number};
    if (const Entry* first = find(entry.key)) {
      refuse(entry, text("the key is already in line %d", first->line));
      return;
    }
    places_.emplace(entry.key, entries_.size());
    entries_.push_back(entry);
  }

  Entry* find(const std::string& key) {
    const auto found = places_.find(key);
    return found == places_.end() ? nullptr : &entries_[found->second];
  }

  std::string name_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> places_;  ///< of a key in `entries_`: a lab's profile has many
  std::string error_;
};

/// One of the words, by its place; refuses any other.
template <class Words>
int read_word(Entries& entries, const std::string& key, const Words& words) {
  const Entry* entry = entries.take(key);
  if (entry == nullptr) {
    return 0;
  }
  const int option = model::option_named(words, entry->value);
  if (option >= 0) {
    return option;
  }
  std::string allowed = "allowed are";
  for (const std::string_view word : words) {
    allowed.append(" ").append(word);
  }
  entries.refuse(*entry, allowed);
  return 0;
}

/// A number within bounds; refuses any other, NaN too.
double read_bounded(Entries& entries, const std::string& key, double lower, double upper, std::string_view unit);

/// A whole number from `least` to `most`; refuses any other. `least` after a refusal.
int read_whole(Entries& entries, const std::string& key, int least, int most);

/// Numbers within bounds, commas between them, exactly as many as `values` has; refuses any other.
void read_list(Entries& entries, const std::string& key, double lower, double upper, std::string_view unit,
               std::span<double> values);

/// The text of a file; an error if it cannot be read.
struct ReadText {
  std::string text;
  std::string error;
};
ReadText read_image_text(const std::string& path);

}  // namespace hotfire::firmware
