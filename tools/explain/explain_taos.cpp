// SPDX-License-Identifier: Apache-2.0

#include <optional>

#include "tools/explain/explain.hpp"
#include "tools/explain/fit/two_axes.hpp"
#include "tools/explain/held_out_records.hpp"
#include "tools/explain/result/conclusion.hpp"
#include "tools/explain/result/result_of.hpp"
#include "tools/explain/result/two_axes_result.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

using Found = SearchResult<SimplexFamily>;
using FoundAxes = std::array<std::optional<Found>, 2>;
using Stage = Assessed<SimplexFamily> Found::*;

/// Both axes at one stage of their searches; an axis without a search stays as it is declared. With attach points in space
/// the arm follows from them, and what the file says of it stays.
TaosParameters together(const TaosParameters& declared, const FoundAxes& found, Stage stage) {
  TaosParameters taos = declared;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) {
      const Fitted<SimplexFamily>& fitted = ((*found[i]).*stage).model;
      taos.axes[i] = Evaluator<SimplexFamily>::with_values(fitted.base, fitted.free, fitted.u);
      if (!taos.constant_arms.front()) {
        taos.axes[i].actuator.moment_arm = declared.axes[i].actuator.moment_arm;
      }
    }
  }
  return taos;
}

/// Progress and messages that say which axis they are about.
Watch watch_of(const Watch& watch, const std::string& axis) {
  Watch own = watch;
  own.progress = [progress = watch.progress, axis](const std::string& what) { progress(axis + ": " + what); };
  return own;
}

Found search_axis(const AxisOfTwo& axis, const ExplainOptions& options) {
  try {
    return search<SimplexFamily>(axis.data, axis.model,
                                 {options.threads, options.most_effects, watch_of(options.watch, axis.name)});
  } catch (const FileError& error) {
    throw FileError(words::of_axis(axis.name, error.what()));
  }
}

/// Fits the explained model of each axis again, beside the other one as that is explained.
void fit_beside_explained(const TaosParameters& declared, const ExplainOptions& options, TwoAxes& axes, FoundAxes& found) {
  const auto run = run_coupled(together(declared, found, &Found::explained), axes, options.threads);
  if (!run) {
    return;
  }
  put_beside(*run, axes);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (found[i]) {
      options.watch.progress(axes[i].name + ": fitting beside the other axis as explained");
      const Evaluator<SimplexFamily> fine(axes[i].data, Resolution::fine);
      Assessed<SimplexFamily> again = refined(fine, fine, options.threads, found[i]->explained.model, kFinal);
      if (again.good()) {
        found[i]->explained = std::move(again);
      }
    }
  }
}

/// Replaces what each axis predicts of itself by what both together predict.
void judge_together(const TaosParameters& declared, unsigned threads, const TwoAxes& axes, FoundAxes& found, Stage stage) {
  const auto run = run_coupled(together(declared, found, stage), axes, threads);
  for (std::size_t i = 0; run && i < axes.size(); ++i) {
    if (found[i]) {
      Assessed<SimplexFamily>& assessed = (*found[i]).*stage;
      assessed.prediction = run->prediction[i];
      assessed.zeros = run->zeros[i];
      assessed.goodness = goodness(axes[i].data, run->prediction[i]);
    }
  }
}

/// The records that were kept back, split into the axes, of which every row that is not excluded is judged.
std::vector<TwoAxes> held_out_axes(const VehicleFile& vehicle, const ExplainOptions& options) {
  std::vector<TwoAxes> kept_back;
  kept_back.reserve(options.kept_back.size());
  for (const Record& record : options.kept_back) {
    kept_back.push_back(axes_of(vehicle, {record}, options.exclusions));
    for (AxisOfTwo& axis : kept_back.back()) {
      fit_every_row(axis.data);
    }
  }
  return kept_back;
}

/// How both axes together do on the records that were kept back, as `held_out_records`, channels by their axis.
std::vector<HeldOutRecord> held_out_together(const TaosParameters& declared, unsigned threads,
                                             const std::vector<TwoAxes>& kept_back, const FoundAxes& found) {
  constexpr std::array<Stage, 3> kStages{&Found::declared, &Found::calibrated, &Found::explained};
  std::vector<HeldOutRecord> records;
  for (const TwoAxes& axes : kept_back) {
    std::array<StagePredictions, 2> stages;
    for (std::size_t s = 0; s < kStages.size(); ++s) {
      const auto run = run_coupled(together(declared, found, kStages[s]), axes, threads);
      if (!run) {
        throw FileError(words::diverges_held_out(axes.front().records.front().path.string()));
      }
      for (std::size_t i = 0; i < axes.size(); ++i) {
        stages[i][s] = run->prediction[i];
      }
    }
    std::vector<AxisHeldOut> judged;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i].measured) {
        judged.push_back({axes[i].name, held_out_record(axes[i].records.front(), axes[i].data, stages[i])});
      }
    }
    records.push_back(joined_record(judged));
  }
  return records;
}

}  // namespace

TaosExplanation explain(const VehicleFile& vehicle, const std::vector<Record>& records, const ExplainOptions& options) {
  TwoAxes axes = axes_of(vehicle, records, options.exclusions);
  const std::vector<TwoAxes> kept_back = held_out_axes(vehicle, options);
  const TaosParameters declared = std::get<TaosParameters>(vehicle.parameters);
  const auto before = run_coupled(declared, axes, options.threads);
  if (!before) {
    throw FileError(words::diverges_declared(vehicle.path.string()));
  }
  put_beside(*before, axes);
  FoundAxes found;
  bool interrupted = false;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].measured) {
      found[i] = search_axis(axes[i], options);
      interrupted = interrupted || found[i]->interrupted;
    }
  }
  if (!interrupted) {
    fit_beside_explained(declared, options, axes, found);
  }
  judge_together(declared, options.threads, axes, found, &Found::declared);
  judge_together(declared, options.threads, axes, found, &Found::calibrated);
  judge_together(declared, options.threads, axes, found, &Found::explained);

  TaosExplanation explanation{{}, {}, vehicle};
  std::vector<AxisResult> results;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!found[i]) {
      continue;
    }
    if (!interrupted) {
      options.watch.progress(axes[i].name + ": fitting what was found to all rows");
      fit_to_all_rows(axes[i].data, options.threads, *found[i]);
    }
    results.push_back({axes[i].name, result_of(axes[i].model, axes[i].records, axes[i].data, *found[i])});
    if (found[i]->rival) {
      results.back().result.residual.next_experiment =
          words::explain_equally(label(found[i]->rival->kept), label(found[i]->rival->other));
    }
    append_series(axes[i].name, series_of(axes[i].records, axes[i].data, *found[i]), explanation.series);
  }
  explanation.result = joined_result(results);
  explanation.result.held_out_records = held_out_together(declared, options.threads, kept_back, found);
  for (const TwoAxes& record : kept_back) {
    warn_of_rows(record[record[0].measured ? 0 : 1].data, explanation.result.warnings);
  }
  TaosParameters plant = together(declared, found, &Found::explained);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (found[i]) {
      plant.axes[i].effects = plant_of(*found[i], options.keep_drift).effects;
    }
  }
  explanation.model.parameters = plant;
  return explanation;
}

}  // namespace hotfire::explain
