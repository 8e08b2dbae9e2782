// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/conclusion.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "tools/explain/inference/profile.hpp"
#include "tools/explain/result/verdict.hpp"
#include "tools/explain/terms/table_points.hpp"
#include "tools/explain/terms/term_constant.hpp"

namespace hotfire::explain {

namespace {

/// Gives the curves of unlisted terms the constants that no record determines, where the error stays.
void choose_constants(const Dataset& data, const Evaluator& whole, unsigned threads, const std::vector<Kept>& found,
                      Assessed& fitted) {
  constexpr double kSameError = 1.001;
  for (const Kept& kept : found) {
    const auto given = with_chosen_constant(data, fitted.zeros, fitted.model, kept.trial.candidate);
    if (!given) {
      continue;
    }
    Assessed moved = assess(whole, threads, *given);
    if (moved.good() &&
        Goodness::combined(moved.goodness.fitted) <= kSameError * Goodness::combined(fitted.goodness.fitted)) {
      fitted = std::move(moved);
    }
  }
}

}  // namespace

ReportSeries series_of(const std::vector<Record>& records, const Dataset& data, const SearchResult& found) {
  const auto input =
      std::visit([](const auto& own) { return PlantOf<decltype(own), double>::input_channel; }, found.explained.model.base);
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
    record.input_name = input;
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

ModelParameters plant_of(const SearchResult& found, bool keep_drift) {
  const Fitted& fitted = found.explained.model;
  ModelParameters plant = fitted.parameters();
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    const bool is_drift = is_of_record_time(candidate) && !keep_drift;
    if (is_fault_of_record(candidate) || (is_drift && !has_mean_over_time(plant, candidate))) {
      set_active(plant, candidate.effect, false);
    } else if (is_drift) {
      visit_table(plant, candidate, [&]<class>(const auto&, auto& table) {
        const auto end = table.y.begin() + table.points;
        std::fill(table.y.begin(), end, std::accumulate(table.y.begin(), end, 0.0) / table.points);
      });
    }
  }
  return plant;
}

void fit_to_all_rows(Dataset data, unsigned threads, SearchResult& found) {
  fit_every_row(data);
  const Evaluator whole(data, Resolution::fine);
  Fitted start = found.explained.model;
  for (const Kept& kept : found.kept) {
    start = reaching_over(data, start, kept.trial.candidate);
  }
  const bool reaches_further = start.free.size() > found.explained.model.free.size();
  Assessed again = refined(whole, whole, threads, std::move(start), reaches_further ? kFinal : kAllRows);
  if (again.good()) {
    if (is_hydraulic_axis(again.model.base)) {
      choose_constants(data, whole, threads, found.kept, again);
    }
    found.explained.model = again.model;
    found.explained.zeros = again.zeros;
    found.profiles = profile_intervals(whole, again.model, threads);
  }
}

}  // namespace hotfire::explain
