// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/result/result.hpp"
#include "tools/report/report_page.hpp"

namespace hotfire::explain {

/// The result of one axis of two.
struct AxisResult {
  std::string axis;  ///< "pitch"
  Result result;
};

/// One held-out record, judged on one axis.
struct AxisHeldOut {
  std::string axis;
  HeldOutRecord record;
};

/// One result of both axes. Channels, sites of `located` and declared parameters have their axis in the name
/// ("piston.pitch", "engine.pitch.inertia"); effects and rows of the search have it as `axis`. The verdict is that of the
/// axis that is explained worse. A text of one axis only begins with its name. Throws std::out_of_range without a result.
Result joined_result(const std::vector<AxisResult>& axes);

/// One held-out record of both axes, channels as `joined_result` has them.
HeldOutRecord joined_record(const std::vector<AxisHeldOut>& axes);

/// Adds the records of one axis to what the page draws, as records of their own.
void append_series(const std::string& axis, ReportSeries own, ReportSeries& all);

}  // namespace hotfire::explain
