// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/report_page.hpp"

namespace hotfire::explain {

/// report.json of one axis of two.
struct AxisReport {
  std::string axis;  ///< "pitch"
  nlohmann::json report;
};

/// One report.json of both: channels and declared parameters with their axis ("piston.pitch", "engine.pitch.inertia"), every
/// effect and every line of the search with an "axis", the verdict of the axis that is the worse explained, and what is said
/// of one axis only given with its name.
nlohmann::json joined_report(const std::vector<AxisReport>& reports);

/// The "channels" of both under their names with the axis; all else as the first has it.
nlohmann::json joined_channels(const std::vector<AxisReport>& reports);

/// Adds the records of one axis to what the page draws, as records of their own.
void append_series(const std::string& axis, ReportSeries own, ReportSeries& all);

}  // namespace hotfire::explain
