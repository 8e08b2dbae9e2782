#pragma once

#include "tools/explain/inference/profile.hpp"
#include "tools/explain/report/verdict.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/explain/terms/table_points.hpp"
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

/// The explained model as a rig runs it: what is a fault of the records and not of the plant is left out.
template <class Family>
PlainParameters<Family> plant_of(const SearchResult<Family>& found) {
  const Fitted<Family>& fitted = found.explained.model;
  PlainParameters<Family> plant = Evaluator<Family>::with_values(fitted.base, fitted.free, fitted.u);
  for (const Kept& kept : found.kept) {
    if (is_fault_of_record(kept.trial.candidate)) {
      plant.effects.active[kept.trial.candidate.effect] = false;
    }
  }
  return plant;
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
  const Assessed<Family> again = refined(whole, whole, threads, std::move(start), reaches_further ? kFinal : kAllRows);
  if (again.good()) {
    found.explained.model = again.model;
    found.profiles = profile_intervals(whole, again.model, threads);
  }
}

}  // namespace hotfire::explain
