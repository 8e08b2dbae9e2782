// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/csv_cells.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace hotfire {

namespace {

/// `text` without these letters at both ends.
std::string_view without(std::string_view around, std::string_view text) {
  const std::size_t first = text.find_first_not_of(around);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(around) - first + 1);
}

}  // namespace

std::string_view trimmed(std::string_view text) { return without(" \t", text); }

std::string_view csv_trimmed(std::string_view text) { return without(" \t\"", text); }

std::vector<std::string_view> parts_of(std::string_view line, char delimiter) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(delimiter, begin), line.size());
    parts.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

std::vector<std::string_view> csv_cells(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells = parts_of(line, delimiter);
  std::transform(cells.begin(), cells.end(), cells.begin(), csv_trimmed);
  return cells;
}

std::optional<double> csv_number(std::string_view cell) {
  double value = 0.0;
  cell.remove_prefix(cell.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool is_whole = error == std::errc{} && end == cell.data() + cell.size() && !cell.empty();
  return is_whole ? std::optional(value) : std::nullopt;
}

}  // namespace hotfire
