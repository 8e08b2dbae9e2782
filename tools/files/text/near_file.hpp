// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "tools/files/text/suggestion.hpp"

namespace hotfire {

/// `; did you mean "rig/declared.toml"?`: the file of the same folder whose name is near that of a file that is not there.
/// Empty if none is near.
inline std::string near_file(const std::filesystem::path& path) {
  constexpr std::size_t kMostFiles = 10'000;
  std::error_code failed;
  std::vector<std::string> names;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end && names.size() < kMostFiles;
       entry.increment(failed)) {
    names.push_back(entry->path().filename().string());
  }
  const std::string wanted = path.filename().string();
  const std::string_view near = nearest_word(wanted, {names.begin(), names.end()});
  return near.empty() || near == wanted ? std::string{}
                                        : fmt::format("; did you mean \"{}\"?", (path.parent_path() / near).string());
}

}  // namespace hotfire
