// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/report/report_page.hpp"

namespace hotfire {

/// The time series as the page's scripts read them: `rows` and `kept` (rows per channel in all records, and how many of them
/// the page holds) and `records[]` with `name`, `start`, `period`, `rows`, `held_out`, `input` and `channels[]`. A
/// channel has `measured` and, per model, its error: measured minus model is subtracted here, in double, so that a residual
/// keeps its digits beside a large measurement. Numbers are base64 of little-endian 32-bit floats; `kept` of a record, if
/// not all its rows are there, of little-endian 32-bit row numbers.
///
/// Throws std::invalid_argument as report_page() does.
nlohmann::json series_data(const ReportSeries& series);

}  // namespace hotfire
