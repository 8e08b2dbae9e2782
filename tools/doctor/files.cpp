// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/files.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace hotfire::doctor {

std::optional<std::string> text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) {
    return std::nullopt;
  }
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) {
    return std::nullopt;
  }
  text.resize(text.find_last_not_of(" \t\n") + 1);
  return text;
}

bool list_has(const std::string& list, int number) {
  std::istringstream ranges(list);
  std::string range;
  while (std::getline(ranges, range, ',')) {
    char* end = nullptr;
    const long first = std::strtol(range.c_str(), &end, 10);
    const long last = *end == '-' ? std::strtol(end + 1, nullptr, 10) : first;
    if (end != range.c_str() && number >= first && number <= last) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    names.push_back(entry->path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace hotfire::doctor
