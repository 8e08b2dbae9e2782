// SPDX-License-Identifier: Apache-2.0
#include "tools/response/measured.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>

#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/csv_lines.hpp"

namespace hotfire::response {

namespace {

constexpr std::string_view kHeading = "condition,axis,resonance[Hz]";

}  // namespace

std::vector<MeasuredAxis> load_measured(const std::filesystem::path& path) {
  CsvLines lines(path);
  std::vector<MeasuredAxis> measured;
  std::string_view line;
  bool has_heading = false;
  while (lines.next(line)) {
    if (csv_trimmed(line).empty() || line.starts_with('#')) {
      continue;
    }
    if (!has_heading) {
      if (csv_trimmed(line) != kHeading) {
        lines.refuse(fmt::format("\"{}\": allowed: the heading {}", line, kHeading));
      }
      has_heading = true;
      continue;
    }
    const std::vector<std::string_view> cells = csv_cells(line, ',');
    const std::optional<double> frequency = cells.size() == 3 ? csv_number(cells[2]) : std::nullopt;
    if (!frequency || cells[0].empty() || cells[1].empty() || !(*frequency > 0.0) || !std::isfinite(*frequency)) {
      lines.refuse(fmt::format("\"{}\": allowed: three cells, {}, the frequency above 0", line, kHeading));
    }
    measured.push_back({std::string{cells[0]}, std::string{cells[1]}, *frequency});
  }
  return measured;
}

}  // namespace hotfire::response
