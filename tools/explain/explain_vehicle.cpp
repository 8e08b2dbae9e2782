// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "tools/explain/explain.hpp"
#include "tools/explain/held_out_records.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/result/axes_result.hpp"
#include "tools/explain/result/conclusion.hpp"
#include "tools/explain/result/result_of.hpp"
#include "tools/explain/vehicle/axis_parameters.hpp"
#include "tools/explain/vehicle/vehicle_axes.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

using Found = SearchResult;
using FoundAxes = std::vector<std::optional<Found>>;
using Stage = Assessed Found::*;

/// All axes at one stage of their searches; an axis without a search stays as it is declared. With attach points in space
/// the arm follows from them, and what the file says of it stays.
VehicleParameters together(const VehicleParameters& declared, const FoundAxes& found, Stage stage) {
  VehicleParameters vehicle = declared;
  std::visit(
      [&](auto& parameters) {
        using Parameters = std::remove_cvref_t<decltype(parameters)>;
        for (std::size_t i = 0; i < found.size(); ++i) {
          if (found[i]) {
            const double declared_arm = parameters.axes[i].actuator.moment_arm;
            const Fitted& fitted = ((*found[i]).*stage).model;
            put_back<typename VehicleOf<Parameters>::Effects>(std::get<SimplexParameters>(fitted.parameters()),
                                                              parameters.axes[i]);
            if (!parameters.constant_arms[i / 2]) {
              parameters.axes[i].actuator.moment_arm = declared_arm;
            }
          }
        }
      },
      vehicle);
  return vehicle;
}

/// Progress and messages that say which axis they are about.
Watch watch_of(const Watch& watch, const std::string& axis, std::size_t searches_to_come) {
  Watch own = watch;
  own.progress = [progress = watch.progress, axis, searches_to_come](const Doing& doing) {
    progress({doing.work, axis + ": " + doing.what, doing.share, searches_to_come});
  };
  return own;
}

Found search_axis(AxisOfVehicle& axis, const ExplainOptions& options, std::size_t searches_to_come) {
  try {
    return search(axis.data, axis.model,
                  {options.threads, options.most_effects, watch_of(options.watch, axis.name, searches_to_come)});
  } catch (const FileError& error) {
    throw FileError(words::of_axis(axis.name, error.what()));
  }
}

/// Puts every axis beside the rest as it is explained so far, unless that runs away.
void put_beside_explained(const VehicleParameters& declared, unsigned threads, const FoundAxes& found,
                          VehicleAxes& vehicle) {
  if (const auto run = run_coupled(together(declared, found, &Found::explained), vehicle, threads)) {
    put_beside(*run, vehicle);
  }
}

/// The axes that are measured, the one with the largest error under the declared model first: what is missing in it
/// disturbs the others the most.
std::vector<std::size_t> largest_error_first(const VehicleAxes& vehicle, const CoupledRun& declared) {
  std::vector<std::pair<double, std::size_t>> errors;
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    if (vehicle.axes[i].measured) {
      errors.emplace_back(-excess_over_noise(vehicle.axes[i].data, declared.prediction[i]), i);
    }
  }
  std::ranges::sort(errors);
  std::vector<std::size_t> order;
  order.reserve(errors.size());
  for (const auto& [error, i] : errors) {
    order.push_back(i);
  }
  return order;
}

/// True if an axis was given effects beside another rest of the vehicle than it is beside now, and the difference changes
/// its error by as much as an effect has to: what was found may explain what was missing elsewhere.
bool is_found_beside_another(const AxisOfVehicle& axis, const Found& found, unsigned threads) {
  if (found.kept.empty()) {
    return false;
  }
  const Assessed now = assess(Evaluator(axis.data, Resolution::fine), threads, found.explained.model);
  return !now.good() || std::abs(held_out_ratio(now, found.explained) - 1.0) > policy().least_held_out_drop;
}

/// Searches the axes one after the other, each beside the rest as it is explained by then, and those that were given effects
/// once more where the later searches change what they are beside. True if it was interrupted.
bool search_axes(const VehicleParameters& declared, const CoupledRun& before, const ExplainOptions& options,
                 VehicleAxes& vehicle, FoundAxes& found) {
  const std::vector<std::size_t> order = largest_error_first(vehicle, before);
  bool interrupted = false;
  for (const bool again : {false, true}) {
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      if (again && (interrupted || !is_found_beside_another(vehicle.axes[i], *found[i], options.threads))) {
        continue;
      }
      found[i] = search_axis(vehicle.axes[i], options, again ? 0 : order.size() - 1 - k);
      interrupted = interrupted || found[i]->interrupted;
      if (!interrupted) {
        put_beside_explained(declared, options.threads, found, vehicle);
      }
    }
  }
  return interrupted;
}

/// Fits the explained model of each axis again, beside the others as those are explained.
void fit_beside_explained(const ExplainOptions& options, const VehicleAxes& vehicle, FoundAxes& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) {
      const AxisOfVehicle& axis = vehicle.axes[i];
      options.watch.progress({Work::concluding, axis.name + ": fitting beside the rest of the vehicle as explained"});
      const Evaluator fine(axis.data, Resolution::fine);
      Assessed again = refined(fine, fine, options.threads, found[i]->explained.model, kFinal);
      if (again.good()) {
        found[i]->explained = std::move(again);
      }
    }
  }
}

/// Replaces what each axis predicts of itself by what all together predict.
void judge_together(const VehicleParameters& declared, unsigned threads, const VehicleAxes& vehicle, FoundAxes& found,
                    Stage stage) {
  const auto run = run_coupled(together(declared, found, stage), vehicle, threads);
  for (std::size_t i = 0; run && i < found.size(); ++i) {
    if (found[i]) {
      Assessed& assessed = (*found[i]).*stage;
      assessed.prediction = run->prediction[i];
      assessed.zeros = run->zeros[i];
      assessed.goodness = goodness(vehicle.axes[i].data, run->prediction[i]);
    }
  }
}

/// The records that were kept back, split into the axes, of which every row that is not excluded is judged.
std::vector<VehicleAxes> held_out_axes(const VehicleFile& vehicle, const ExplainOptions& options) {
  std::vector<VehicleAxes> kept_back;
  kept_back.reserve(options.kept_back.size());
  for (const Record& record : options.kept_back) {
    kept_back.push_back(axes_of(vehicle, {record}, options.exclusions));
    for (AxisOfVehicle& axis : kept_back.back().axes) {
      fit_every_row(axis.data);
    }
  }
  return kept_back;
}

/// How all axes together do on the records that were kept back, as `held_out_records`, channels by their axis.
std::vector<HeldOutRecord> held_out_together(const VehicleParameters& declared, unsigned threads,
                                             const std::vector<VehicleAxes>& kept_back, const FoundAxes& found) {
  constexpr std::array<Stage, 3> kStages{&Found::declared, &Found::calibrated, &Found::explained};
  std::vector<HeldOutRecord> records;
  for (const VehicleAxes& vehicle : kept_back) {
    std::vector<StagePredictions> stages(vehicle.axes.size());
    for (std::size_t s = 0; s < kStages.size(); ++s) {
      auto run = run_coupled(together(declared, found, kStages[s]), vehicle, threads);
      if (!run) {
        throw FileError(words::diverges_held_out(vehicle.disturbances.front().path.string()));
      }
      for (std::size_t i = 0; i < stages.size(); ++i) {
        stages[i][s] = std::move(run->prediction[i]);
      }
    }
    std::vector<AxisHeldOut> judged;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const AxisOfVehicle& axis = vehicle.axes[i];
      if (axis.measured) {
        judged.push_back({axis.name, held_out_record(axis.records.front(), axis.data, stages[i])});
      }
    }
    records.push_back(joined_record(judged));
  }
  return records;
}

/// The explained model of all axes, of an axis without faults of its records.
VehicleParameters explained_vehicle(const VehicleParameters& declared, const FoundAxes& found, bool keep_drift) {
  VehicleParameters vehicle = together(declared, found, &Found::explained);
  std::visit(
      [&](auto& parameters) {
        using Effects = typename VehicleOf<std::remove_cvref_t<decltype(parameters)>>::Effects;
        for (std::size_t i = 0; i < found.size(); ++i) {
          if (found[i]) {
            SimplexParameters axis = alone<Effects>(parameters.axes[i]);
            axis.effects = std::get<SimplexParameters>(plant_of(*found[i], keep_drift)).effects;
            put_back<Effects>(axis, parameters.axes[i]);
          }
        }
      },
      vehicle);
  return vehicle;
}

}  // namespace

VehicleExplanation explain(const VehicleFile& model, const std::vector<Record>& records, const ExplainOptions& options) {
  VehicleAxes vehicle = axes_of(model, records, options.exclusions);
  const std::vector<VehicleAxes> kept_back = held_out_axes(model, options);
  const VehicleParameters& declared = model.parameters;
  const auto before = run_coupled(declared, vehicle, options.threads);
  if (!before) {
    throw FileError(words::diverges_declared(model.path.string()));
  }
  put_beside(*before, vehicle);
  FoundAxes found(vehicle.axes.size());
  const bool interrupted = search_axes(declared, *before, options, vehicle, found);
  if (!interrupted) {
    fit_beside_explained(options, vehicle, found);
  }
  for (const Stage stage : {&Found::declared, &Found::calibrated, &Found::explained}) {
    judge_together(declared, options.threads, vehicle, found, stage);
  }

  VehicleExplanation explanation{{}, {}, model};
  std::vector<AxisResult> results;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) {
      continue;
    }
    const AxisOfVehicle& axis = vehicle.axes[i];
    if (!interrupted) {
      options.watch.progress(
          {Work::concluding, axis.name + ": fitting what was found to all rows", SharesOfWork::kFittedBesideAxis});
      fit_to_all_rows(axis.data, options.threads, *found[i]);
    }
    results.push_back({axis.name, result_of(axis.model, axis.records, axis.data, *found[i])});
    if (found[i]->rival) {
      results.back().result.residual.next_experiment =
          words::explain_equally(label(found[i]->rival->kept), label(found[i]->rival->other));
    }
    append_series(axis.name, series_of(axis.records, axis.data, *found[i]), explanation.series);
  }
  explanation.result = joined_result(results);
  explanation.result.held_out_records = held_out_together(declared, options.threads, kept_back, found);
  for (const VehicleAxes& record : kept_back) {
    warn_of_rows(record.first_measured().data, explanation.result.warnings);
  }
  explanation.model.parameters = explained_vehicle(declared, found, options.keep_drift);
  return explanation;
}

}  // namespace hotfire::explain
