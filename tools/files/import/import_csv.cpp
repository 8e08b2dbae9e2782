#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "tools/files/import/import.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\"";
  const std::size_t first = text.find_first_not_of(kSpace);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells;
  for (bool more = true; more;) {
    const std::size_t end = line.find(delimiter);
    cells.push_back(trimmed(line.substr(0, end)));
    more = end != std::string_view::npos;
    line.remove_prefix(more ? end + 1 : line.size());
  }
  return cells;
}

double number_of(const CsvLines& lines, std::string_view cell, const std::string& column) {
  if (cell.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double value = 0.0;
  const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    lines.refuse(fmt::format("column \"{}\": \"{}\" is not a number; allowed: a decimal number with a point", column,
                             cell.substr(0, 40)));
  }
  return value;
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
  const std::vector<std::string_view> names = cells_of(header, map.delimiter);
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
    if (trimmed(line).empty()) {
      continue;
    }
    if (values.front().size() == kMostRows) {
      lines.refuse(fmt::format("more than {} rows; cut the file into parts", kMostRows));
    }
    const std::vector<std::string_view> cells = cells_of(line, map.delimiter);
    const bool has_values = map.events.empty() ? cells.size() == names.size() : cells.size() + 1 >= names.size();
    if (!has_values) {
      const bool may_be_events = map.events.empty() && cells.size() + 1 >= names.size();
      lines.refuse(fmt::format(
          "{} columns; the header has {}{}", cells.size(), names.size(),
          may_be_events ? fmt::format("; where only some rows say what happened, write [csv] events = \"{}\"", names.back())
                        : ""));
    }
    for (std::size_t c = 0; c < places.size(); ++c) {
      values[c].push_back(number_of(lines, cells[places[c]], map.columns[c].column));
    }
  }
  return values;
}

}  // namespace hotfire
