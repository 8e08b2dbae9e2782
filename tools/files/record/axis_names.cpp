// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/axis_names.hpp"

#include <fmt/format.h>

namespace hotfire {

std::vector<std::string> tables_of_axis(int axis, int engines) {
  std::vector<std::string> names{axis % 2 == 0 ? "pitch" : "yaw"};
  if (engines > 1) {
    names.push_back(fmt::format("{}{}", names.front(), axis / 2 + 1));
  }
  return names;
}

std::vector<std::string> axis_names(int engines) {
  std::vector<std::string> names;
  names.reserve(2 * static_cast<std::size_t>(engines));
  for (int axis = 0; axis < 2 * engines; ++axis) {
    names.push_back(tables_of_axis(axis, engines).back());
  }
  return names;
}

std::string key_of_axis(const std::string& key, const std::string& axis) {
  const auto dot = key.find('.');
  return key.substr(0, dot + 1) + axis + key.substr(dot);
}

}  // namespace hotfire
