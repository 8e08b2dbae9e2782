// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "tools/files/import/import.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

/// Throws FileError unless the columns of a map have the same number of rows.
inline void require_equal_rows(const std::filesystem::path& path, const ImportMap& map,
                               const std::vector<std::vector<double>>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() != values.front().size()) {
      throw FileError(fmt::format("{}: {} has {} rows, {} has {}; a record has as many of each", path.string(),
                                  map.columns[i].column, values[i].size(), map.columns.front().column,
                                  values.front().size()));
    }
  }
}

}  // namespace hotfire
