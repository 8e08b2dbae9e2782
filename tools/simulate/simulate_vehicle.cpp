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
#include "tools/simulate/excitation.hpp"
#include "tools/simulate/run.hpp"
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kCommand = "command.";
constexpr std::string_view kVibration = "vibration.";
constexpr std::string_view kTorque = "torque.";
constexpr std::string_view kForce = "force.";

/// The channel `kind` of every axis, or whatever else it is of; null where the record has none. Refuses one of an axis that
/// the model has not.
std::vector<const Channel*> channels_of(const Record& inputs, std::string_view kind, const std::vector<std::string>& axes) {
  std::vector<const Channel*> channels;
  channels.reserve(axes.size());
  for (const std::string& axis : axes) {
    channels.push_back(inputs.find(std::string(kind) + axis));
  }
  for (const Channel& channel : inputs.channels) {
    const std::string_view name = channel.name;
    if (name.starts_with(kind) && std::find(axes.begin(), axes.end(), name.substr(kind.size())) == axes.end()) {
      throw FileError(fmt::format("{}:1: {}: the model has no such axis; allowed: {}", inputs.path.string(), name,
                                  fmt::join(axes, ", ")));
    }
  }
  return channels;
}

/// The command channel of every axis; null where the record has none.
std::vector<const Channel*> command_channels(const Record& inputs, const std::vector<std::string>& axes) {
  std::vector<const Channel*> channels = channels_of(inputs, kCommand, axes);
  if (std::all_of(channels.begin(), channels.end(), [](const Channel* channel) { return channel == nullptr; })) {
    require_channel(inputs, std::string(kCommand) + axes.front(), "the model is driven by it and its like");
  }
  return channels;
}

/// What a record has for each of `places` beside the commands, as a sampled signal that is interpolated between rows.
class RecordedInput {
 public:
  RecordedInput(const Record& inputs, std::string_view kind, const std::vector<std::string>& places, int steps) {
    const std::vector<const Channel*> channels = channels_of(inputs, kind, places);
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i] != nullptr) {
        signals_.push_back({i, channels[i], Excitation(channels[i]->values, steps, Excitation::Between::interpolated)});
      }
    }
  }

  struct Signal {
    std::size_t place;
    const Channel* channel;
    Excitation mean;  ///< over plant step `step` of a row
  };
  const std::vector<Signal>& signals() const { return signals_; }

 private:
  std::vector<Signal> signals_;
};

/// The thrust of an engine, held between rows like a command. Refuses one below zero.
template <class Plant>
std::array<const Channel*, Plant::kEngines> thrust_channels(const Record& inputs, const std::vector<std::string>& engines) {
  std::array<const Channel*, Plant::kEngines> thrust{};
  const std::vector<const Channel*> channels =
      Plant::kEngines == 1 ? std::vector{inputs.find("thrust")} : channels_of(inputs, "thrust.", engines);
  std::copy(channels.begin(), channels.end(), thrust.begin());
  for (const Channel* channel : channels) {
    const auto below = channel == nullptr
                           ? std::ptrdiff_t{-1}
                           : std::find_if(channel->values.begin(), channel->values.end(), [](double n) { return n < 0.0; }) -
                                 channel->values.begin();
    if (channel != nullptr && below < static_cast<std::ptrdiff_t>(channel->values.size())) {
      throw FileError(fmt::format("{}: row {}: {} = {} N; allowed: at least 0", inputs.path.string(), below + 1,
                                  channel->name, channel->values[static_cast<std::size_t>(below)]));
    }
  }
  return thrust;
}

/// Everything that works on the engines of a vehicle beside its commands: recorded vibration, torque, force and thrust.
template <class Plant>
class Disturbances {
 public:
  /// Refuses a record of a vibration for a bearing whose law has it already.
  Disturbances(const Record& inputs, const typename Plant::Parameters& parameters, int steps)
      : parameters_(parameters),
        vibration_(inputs, kVibration, axis_names(Plant::kEngines), steps),
        torque_(inputs, kTorque, axis_names(Plant::kEngines), steps),
        force_(inputs, kForce, names_of_directions(), steps),
        thrust_(thrust_channels<Plant>(inputs, names_of_engines())) {
    for (const auto& signal : vibration_.signals()) {
      if (parameters.gimbals[signal.place / 2].friction.law() == model::BearingFriction<double>::Law::vibrated_lugre) {
        throw FileError(
            fmt::format("{}:1: {}: the model's gimbal has law \"vibrated_lugre\"; it and a recorded vibration are two ways "
                        "to the same physics; give one of them",
                        inputs.path.string(), signal.channel->name));
      }
    }
  }

  void put(std::size_t row, int step, typename Plant::Inputs& inputs) const {
    for (const auto& signal : vibration_.signals()) {
      inputs.vibration[signal.place] = signal.mean(row, step);
    }
    for (const auto& signal : torque_.signals()) {
      inputs.torque[signal.place] = signal.mean(row, step);
    }
    for (const auto& signal : force_.signals()) {
      inputs.force[signal.place / 3](static_cast<Eigen::Index>(signal.place % 3)) = signal.mean(row, step);
    }
    for (std::size_t e = 0; e < thrust_.size(); ++e) {
      inputs.thrust[e] = thrust_[e] != nullptr ? thrust_[e]->values[row] - parameters_.gimbals[e].bearing.thrust : 0.0;
    }
  }

 private:
  static std::vector<std::string> names_of_engines() {
    std::vector<std::string> names;
    for (int e = 1; e <= Plant::kEngines; ++e) {
      names.push_back(fmt::format("engine{}", e));
    }
    return names;
  }
  static std::vector<std::string> names_of_directions() {
    std::vector<std::string> names;
    for (int e = 1; e <= Plant::kEngines; ++e) {
      for (const char* direction : {"x", "y", "z"}) {
        names.push_back(Plant::kEngines == 1 ? direction : fmt::format("{}{}", direction, e));
      }
    }
    return names;
  }

  const typename Plant::Parameters& parameters_;
  RecordedInput vibration_;
  RecordedInput torque_;
  RecordedInput force_;
  std::array<const Channel*, Plant::kEngines> thrust_;
};

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
    outputs.channels.push_back({std::string(kCommand) + axes[i], "rad",
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
  const Disturbances<Plant> disturbances(inputs, parameters, steps);
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
