// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "tools/files/import/import.hpp"
#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

double number_of(const CsvLines& lines, std::string_view cell, const std::string& column) {
  if (cell.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::optional<double> value = csv_number(cell);
  if (!value) {
    lines.refuse(fmt::format("column \"{}\": \"{}\" is not a number; allowed: a decimal number with a point", column,
                             cell.substr(0, 40)));
  }
  return *value;
}

}  // namespace

std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path, const ImportMap& map) {
  CsvLines lines(path);
  std::string_view line;
  for (std::size_t skipped = 0; skipped <= map.skip_lines; ++skipped) {
    if (!lines.next(line)) {
      throw FileError(fmt::format("{}: ends before its header, line {}", path.string(), map.skip_lines + 1));
    }
  }
  const std::string header(line);
  const std::vector<std::string_view> names = csv_cells(header, map.delimiter);
  if (!map.events.empty() && names.back() != map.events) {
    lines.refuse(
        fmt::format("[csv] events = \"{}\" has to be the last column; there are: {}", map.events, fmt::join(names, " | ")));
  }
  std::vector<std::size_t> places;
  for (const ImportColumn& column : map.columns) {
    const auto found = std::find(names.begin(), names.end(), column.column);
    if (found == names.end()) {
      lines.refuse(
          fmt::format("no column \"{}\" for {}; there are: {}", column.column, column.channel, fmt::join(names, " | ")));
    }
    if (std::count(names.begin(), names.end(), column.column) > 1) {
      lines.refuse(fmt::format("column \"{}\" is there more than once; rename one", column.column));
    }
    places.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  std::vector<std::vector<double>> values(map.columns.size());
  while (lines.next(line)) {
    if (csv_trimmed(line).empty()) {
      continue;
    }
    if (values.front().size() == kMostRows) {
      lines.refuse(fmt::format("more than {} rows; cut the file into parts", kMostRows));
    }
    const std::vector<std::string_view> cells = csv_cells(line, map.delimiter);
    const bool has_values = map.events.empty() ? cells.size() == names.size() : cells.size() + 1 >= names.size();
    if (!has_values) {
      const bool may_be_events = map.events.empty() && cells.size() + 1 >= names.size();
      lines.refuse(fmt::format(
          "{} columns; the header has {}{}", cells.size(), names.size(),
          may_be_events ? fmt::format("; if only some rows have an event, write [csv] events = \"{}\"", names.back()) : ""));
    }
    for (std::size_t c = 0; c < places.size(); ++c) {
      values[c].push_back(number_of(lines, cells[places[c]], map.columns[c].column));
    }
  }
  return values;
}

}  // namespace hotfire
