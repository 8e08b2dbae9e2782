// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/report/report_page.hpp"

namespace hotfire::test {

/// A report and its series, as the finder would hand them over.
struct Sample {
  nlohmann::json report;
  ReportSeries series;
};

/// Three channels, three records, friction and a soft stiffness found, one parameter undetermined, every section filled.
Sample explained_actuator();

/// One unit-less channel, one record, nothing missing: only what the page must have.
Sample nothing_missing_mass();

/// Ten records with more rows than the page holds, and names and texts that try to become markup or script.
Sample hostile_long_records();

}  // namespace hotfire::test
