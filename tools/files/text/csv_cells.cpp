// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/csv_cells.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace hotfire {

std::string_view csv_trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\"";
  const std::size_t first = text.find_first_not_of(kAround);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

std::vector<std::string_view> csv_cells(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(delimiter, begin), line.size());
    cells.push_back(csv_trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
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
