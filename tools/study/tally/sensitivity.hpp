// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire::study {

/// What is varied: a constant of the finder's policy (tools/explain/policy/policy.hpp) by a factor. No constant: as it is.
struct Variation {
  std::string_view constant;
  double factor = 1.0;
};

/// The policy as it is, then every constant times 0.7 and times 1.4. `only` names constants; empty: all. Throws UsageError
/// for a name that the policy does not have.
std::vector<Variation> variations(const std::vector<std::string>& only);

/// The ruling on one case under one variation.
struct Ruling {
  std::string constant;  ///< empty: the policy as it is
  double factor = 1.0;
  std::string name;   ///< of the case
  bool good = false;  ///< listed: named right and below the noise; unlisted: no wrong name, right site, error halved; null:
                      ///< no find
};

/// Explains every case under every variation and says each ruling as it is made. Rulings of `known` are not made again: a
/// run that was stopped goes on. Throws FileError if a folder is no case.
std::vector<Ruling> sensitivity(const std::vector<std::filesystem::path>& folders, const std::vector<Variation>& varied,
                                std::vector<Ruling> known, unsigned threads, const std::function<void(const Ruling&)>& say);

/// Cases whose ruling a variation changes, out of those that were ruled on under it and under the policy as it is.
struct Change {
  Variation variation;
  std::size_t better = 0;
  std::size_t worse = 0;
  std::size_t of = 0;
};
std::vector<Change> changes_of(const std::vector<Ruling>& rulings, const std::vector<Variation>& varied);

/// The most changes of a constant that the study accepts.
inline constexpr std::size_t kMostChanges = 2;

std::string table_of(const std::vector<Change>& changes);
nlohmann::json json_of(const Ruling& ruling);

/// Reads rulings, one JSON object a line. No file: none. Throws FileError for a line that is no ruling.
std::vector<Ruling> load_rulings(const std::filesystem::path& path);

}  // namespace hotfire::study
