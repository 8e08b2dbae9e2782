// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace hotfire {

/// Above this many rows per channel, summed over all records, a page holds extremes instead of every row.
inline constexpr std::size_t kFullResolutionRows = 200'000;

/// One measured channel beside what each model says of it. A model that was not run is empty; otherwise every vector has as
/// many rows as `measured`. A value that does not exist (before a model's start) is NaN and is drawn as a gap.
struct ReportChannel {
  std::string name;  ///< "piston"
  std::string unit;  ///< UDUNITS-2 string in which the values are, "m"; "" or "1" for none
  std::vector<double> measured;
  std::vector<double> declared;    ///< the model as it was given: `before` in report.json
  std::vector<double> calibrated;  ///< its parameters refitted within tolerance, no effect added
  std::vector<double> after;       ///< with the effects
};

/// One record. Rows are `start + i * period`, in seconds.
struct ReportRecord {
  std::string name;  ///< "steps.csv"
  double start = 0.0;
  double period = 0.0;
  std::vector<std::pair<double, double>> held_out;  ///< intervals [s] on the record's time axis that no fit has seen
  std::string input_name;                           ///< "command"; empty if there is none to show
  std::string input_unit;
  std::vector<double> input;
  std::vector<ReportChannel> channels;
};

struct ReportSeries {
  std::vector<ReportRecord> records;
};

/// The result of `hotfire explain` as one HTML file that opens without a network: its text, style, scripts (dygraphs
/// among them) and data are all inside.
///
/// `report` is report.json; docs/report.md names every key. Only `verdict` and `channels` must be there: a section whose
/// keys are absent, null or empty is left out of the page. All text in it is shown as text, never as markup.
///
/// `series` may be empty. Up to kFullResolutionRows the page holds every row, as 32-bit floats. Above, each record keeps the
/// rows at which the input, a measurement or a residual is smallest or largest within one of equal stretches of
/// time; the page says so and how many rows that left.
///
/// Throws std::invalid_argument if `report` is no object or has no `verdict` or `channels`, or if a record has no period,
/// or vectors of different lengths; the message names the record and the channel.
std::string report_page(const nlohmann::json& report, const ReportSeries& series);

}  // namespace hotfire
