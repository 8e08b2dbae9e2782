// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "tools/files/import/apart.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/import/matlab_layout.hpp"
#include "tools/files/import/matlab_reader.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

std::vector<std::vector<double>> columns_of(std::string_view text) {
  std::vector<std::vector<double>> columns;
  while (text.size() >= sizeof(std::uint64_t)) {
    std::uint64_t rows = 0;
    std::memcpy(&rows, text.data(), sizeof rows);
    text.remove_prefix(sizeof rows);
    std::vector<double>& values = columns.emplace_back(std::min<std::size_t>(rows, text.size() / sizeof(double)));
    if (!values.empty()) {
      std::memcpy(values.data(), text.data(), values.size() * sizeof(double));
    }
    text.remove_prefix(values.size() * sizeof(double));
  }
  return columns;
}

}  // namespace

// What matio does with a damaged file is its own affair: it has crashed on damaged structs.
std::vector<std::vector<double>> read_matlab_columns(const std::filesystem::path& path, const ImportMap& map) {
  if (!std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("{}: is no file; allowed: a MATLAB file", path.string()));
  }
  require_matlab_layout(path);
  const std::size_t most_bytes = map.columns.size() * sizeof(double) * (kMostRows + 1);
  std::vector<std::vector<double>> values;
  try {
    values = columns_of(run_apart([&] { return matlab_columns_text(path, map); }, matlab_limits(most_bytes)));
  } catch (const ApartError& error) {
    throw FileError(fmt::format("{}: cannot be read as a MATLAB file: {}; it is damaged: save it again with -v7",
                                path.string(), error.what()));
  }
  if (values.size() != map.columns.size()) {
    throw FileError(fmt::format("{}: cannot be read as a MATLAB file: {} columns came of {}", path.string(), values.size(),
                                map.columns.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() != values.front().size()) {
      throw FileError(fmt::format("{}: {} has {} rows, {} has {}; a record has as many of each", path.string(),
                                  map.columns[i].column, values[i].size(), map.columns.front().column,
                                  values.front().size()));
    }
  }
  return values;
}

}  // namespace hotfire
