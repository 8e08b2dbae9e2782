// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulate_vehicle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "model/numerics/step_size.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/run.hpp"
#include "tools/simulate/vehicle_disturbances.hpp"
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kCommand = "command";

/// The command channel of every axis; null where the record has none.
std::vector<const Channel*> command_channels(const Record& inputs, const std::vector<std::string>& axes) {
  std::vector<const Channel*> channels = channels_by_place(inputs, kCommand, axes);
  if (std::all_of(channels.begin(), channels.end(), [](const Channel* channel) { return channel == nullptr; })) {
    require_channel(inputs, fmt::format("{}.{}", kCommand, axes.front()), "the model is driven by it and its like");
  }
  return channels;
}

/// A record with a channel for all that a run gives, and the commands filled in.
template <class Plant>
Record empty_outputs(const VehicleFile& model, const Record& inputs) {
  const std::vector<std::string> axes = axis_names(Plant::kEngines);
  const std::vector<const Channel*> commands = command_channels(inputs, axes);
  Record outputs;
  outputs.start = inputs.start;
  outputs.period = inputs.period;
  outputs.rows = inputs.rows;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    outputs.channels.push_back({fmt::format("{}.{}", kCommand, axes[i]), "rad",
                                commands[i] != nullptr ? commands[i]->values : std::vector<double>(inputs.rows, 0.0)});
    for (std::size_t c = 0; c < Plant::kChannels; ++c) {
      outputs.channels.push_back({fmt::format("{}.{}", Plant::AxisModel::channels[c], axes[i]),
                                  std::string(Plant::AxisModel::channel_units[c]), std::vector<double>(inputs.rows)});
    }
  }
  for (std::size_t e = 1; e <= model.sensors.strings.size(); ++e) {
    for (std::size_t k = 1; k <= VehicleSensors::Strings::kStrings; ++k) {
      outputs.channels.push_back({Plant::kEngines == 1 ? fmt::format("string{}", k) : fmt::format("string{}.engine{}", k, e),
                                  "m", std::vector<double>(inputs.rows)});
    }
  }
  return outputs;
}

template <class Plant>
Record simulate_on(const typename Plant::Parameters& parameters, const VehicleFile& model, const Record& inputs,
                   const VehicleRun& run) {
  const int steps = model::steps_per_period(inputs.period);
  const Plant plant(parameters, inputs.period / steps);
  Record outputs = empty_outputs<Plant>(model, inputs);
  constexpr std::size_t kColumns = Plant::kChannels + 1;
  constexpr std::size_t kStrings = Plant::kAxes * kColumns;
  std::array<std::span<const double>, Plant::kAxes> held;
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i] = outputs.channels[i * kColumns].values;
  }
  const VehicleDisturbances<Plant> disturbances(inputs, parameters, steps);
  typename Plant::Inputs first;
  disturbances.put(0, 0, first);
  const auto disturb = [&](std::size_t row, int step, auto& state, auto& driven) {
    for (std::size_t i = 0; step == 0 && i < run.impulses.size(); ++i) {
      state.axes[i].y(Plant::AxisModel::kAngleRate) += run.impulses[i][row] / parameters.axes[i].engine.inertia;
    }
    disturbances.put(row, step, driven);
  };
  Normal normal(run.seed);
  const model::VehicleSensors<Plant> sensors = sensors_in_place<Plant>(model.sensors, normal);
  const std::size_t strings = model.sensors.strings.size() * VehicleSensors::Strings::kStrings;
  std::optional<model::VehicleReadings<Plant>> readings;
  std::size_t rows = 0;
  const bool finite = run_vehicle(plant, held, inputs.start, steps, first, disturb, [&](std::size_t row, const auto& state) {
    if (!readings) {
      readings.emplace(sensors, state);
    }
    readings->read_pistons(state, inputs.period, normal);
    if (strings > 0) {
      readings->read_strings(state, inputs.period, normal);
    }
    const auto& measured = Plant::measured(state);
    for (std::size_t r = 0; r < measured.size(); ++r) {
      const std::size_t axis = r / Plant::kChannels;
      const std::size_t channel = r % Plant::kChannels;
      outputs.channels[axis * kColumns + 1 + channel].values[row] = channel == 0 ? readings->pistons()[axis] : measured[r];
    }
    for (std::size_t k = 0; k < strings; ++k) {
      outputs.channels[kStrings + k].values[row] = readings->strings()[k];
    }
    rows = row + 1;
  });
  if (!finite) {
    throw FileError(fmt::format("{}: the model runs away at {:.6g} s: its parameters make it unstable for these commands",
                                inputs.path.string(), inputs.start + static_cast<double>(rows) * inputs.period));
  }
  return outputs;
}

/// What `f.template operator()<Plant>(parameters)` says of the model's plant.
template <class F>
auto with_plant(const VehicleFile& model, F&& f) {
  if (const auto* taos = std::get_if<TaosParameters>(&model.parameters)) {
    return f.template operator()<model::Taos<double>>(*taos);
  }
  return f.template operator()<model::Masv<double>>(std::get<MasvParameters>(model.parameters));
}

}  // namespace

Record simulate(const VehicleFile& model, const Record& inputs, const VehicleRun& run) {
  return with_plant(model, [&]<class Plant>(const typename Plant::Parameters& parameters) {
    return simulate_on<Plant>(parameters, model, inputs, run);
  });
}

std::size_t axis_index(const VehicleFile& model, const std::string& axis) {
  const std::vector<std::string> axes =
      with_plant(model, []<class Plant>(const typename Plant::Parameters&) { return axis_names(Plant::kEngines); });
  const auto found = std::find(axes.begin(), axes.end(), axis);
  if (found == axes.end()) {
    throw UsageError(fmt::format("--axis {}: the model has no such axis; allowed: {}", axis, fmt::join(axes, ", ")));
  }
  return static_cast<std::size_t>(found - axes.begin());
}

double moment_arm_of(const VehicleFile& model, const std::string& axis) {
  const std::size_t index = axis_index(model, axis);
  return with_plant(model, [&]<class Plant>(const typename Plant::Parameters& parameters) {
    return Plant::geometry_of(parameters, index / 2).at(0.0, 0.0).arm[index % 2][index % 2];
  });
}

}  // namespace hotfire
