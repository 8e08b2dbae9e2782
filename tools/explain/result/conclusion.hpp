// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <numeric>

#include "tools/explain/inference/profile.hpp"
#include "tools/explain/result/verdict.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/explain/terms/table_points.hpp"
#include "tools/explain/terms/term_constant.hpp"
#include "tools/report/report_page.hpp"

namespace hotfire::explain {

// What every explanation ends with, of one axis or of several.

/// What the page draws of one search.
template <class Family>
ReportSeries series_of(const std::vector<Record>& records, const Dataset& data, const SearchResult<Family>& found) {
  ReportSeries series;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    ReportRecord record;
    record.name = experiment.name;
    record.start = experiment.start;
    record.period = experiment.period;
    for (const Block& block : experiment.held_out) {
      record.held_out.emplace_back(experiment.time_of(block.first), experiment.time_of(block.last));
    }
    record.input_name = Family::template Plant<double>::input_channel;
    record.input_unit = records[e].find(record.input_name)->unit;
    record.input = experiment.input;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (!experiment.measured[c].empty()) {
        record.channels.push_back({data.channels[c], records[e].find(data.channels[c])->unit, experiment.measured[c],
                                   found.declared.prediction[e][c], found.calibrated.prediction[e][c],
                                   found.explained.prediction[e][c]});
      }
    }
    series.records.push_back(std::move(record));
  }
  return series;
}

/// The explained model as a rig runs it: what is a fault of the records and not of the plant is left out. What drifted over
/// the time of a record is set to its mean, since another run has another clock; unless `keep_drift`.
template <class Family>
PlainParameters<Family> plant_of(const SearchResult<Family>& found, bool keep_drift) {
  const Fitted<Family>& fitted = found.explained.model;
  PlainParameters<Family> plant = Evaluator<Family>::with_values(fitted.base, fitted.free, fitted.u);
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    if (is_fault_of_record(candidate)) {
      plant.effects.active[candidate.effect] = false;
    } else if (is_of_record_time(candidate) && !keep_drift) {
      visit_table(plant, candidate, [&]<class>(const auto&, auto& table) {
        const auto end = table.y.begin() + table.points;
        std::fill(table.y.begin(), end, std::accumulate(table.y.begin(), end, 0.0) / table.points);
      });
    }
  }
  return plant;
}

/// Gives the curves of unlisted terms the constants with which the records have the least zeros, where the error stays.
inline void choose_constants(const Dataset& data, const Evaluator<SimplexFamily>& whole, unsigned threads,
                             const std::vector<Kept>& found, Assessed<SimplexFamily>& fitted) {
  constexpr double kSameError = 1.001;
  for (const Kept& kept : found) {
    const auto least = with_least_zeros(data, fitted.zeros, fitted.model, kept.trial.candidate);
    if (!least) {
      continue;
    }
    Assessed<SimplexFamily> moved = assess(whole, threads, *least);
    if (moved.good() &&
        Goodness::combined(moved.goodness.fitted) <= kSameError * Goodness::combined(fitted.goodness.fitted)) {
      fitted = std::move(moved);
    }
  }
}

/// The explained model fitted once more, to the rows that were held out as well: what the rig runs has seen all that there
/// is, its tables reaching over them, with the intervals that its profile gives. The errors of `found` stay those of the fit
/// that had not seen them.
template <class Family>
void fit_to_all_rows(Dataset data, unsigned threads, SearchResult<Family>& found) {
  fit_every_row(data);
  const Evaluator<Family> whole(data, Resolution::fine);
  Fitted<Family> start = found.explained.model;
  for (const Kept& kept : found.kept) {
    start = reaching_over(data, start, kept.trial.candidate);
  }
  const bool reaches_further = start.free.size() > found.explained.model.free.size();
  Assessed<Family> again = refined(whole, whole, threads, std::move(start), reaches_further ? kFinal : kAllRows);
  if (again.good()) {
    if constexpr (std::is_same_v<Family, SimplexFamily>) {
      choose_constants(data, whole, threads, found.kept, again);
    }
    found.explained.model = again.model;
    found.explained.zeros = again.zeros;
    found.profiles = profile_intervals(whole, again.model, threads);
  }
}

}  // namespace hotfire::explain
