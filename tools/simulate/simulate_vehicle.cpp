#include "tools/simulate/simulate_vehicle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "model/step_size.hpp"
#include "tools/files/error.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kCommand = "command.";

/// The command channel of every axis; null where the record has none.
std::vector<const Channel*> command_channels(const Record& inputs, const std::vector<std::string>& axes) {
  std::vector<const Channel*> channels;
  channels.reserve(axes.size());
  for (const std::string& axis : axes) {
    channels.push_back(inputs.find(std::string(kCommand) + axis));
  }
  for (const Channel& channel : inputs.channels) {
    const std::string_view name = channel.name;
    if (name.starts_with(kCommand) && std::find(axes.begin(), axes.end(), name.substr(kCommand.size())) == axes.end()) {
      throw FileError(fmt::format("{}:1: {}: the model has no such axis; allowed: {}", inputs.path.string(), name,
                                  fmt::join(axes, ", ")));
    }
  }
  if (std::all_of(channels.begin(), channels.end(), [](const Channel* channel) { return channel == nullptr; })) {
    require_channel(inputs, std::string(kCommand) + axes.front(), "the model is driven by it and its like");
  }
  return channels;
}

template <class Plant>
Record run_vehicle(const typename Plant::Parameters& parameters, const Record& inputs) {
  const int steps = model::steps_per_period(inputs.period);
  const Plant plant(parameters, inputs.period / steps);
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
  constexpr std::size_t kColumns = Plant::kChannels + 1;
  typename Plant::Inputs driven;
  const auto command_at = [&](std::size_t row) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      driven.commands[i] = outputs.channels[i * kColumns].values[row];
    }
  };
  command_at(0);
  typename Plant::State state = plant.steady(driven.commands);
  for (auto& axis : state.axes) {
    axis.clock = inputs.start;
  }
  for (std::size_t row = 0; row < inputs.rows; ++row) {
    const auto& readings = Plant::measured(state);
    for (std::size_t r = 0; r < readings.size(); ++r) {
      if (!(std::abs(readings[r]) < kRunaway)) {
        throw FileError(
            fmt::format("{}: the model runs away at {:.6g} s: its parameters make it unstable for these commands",
                        inputs.path.string(), inputs.start + static_cast<double>(row) * inputs.period));
      }
      outputs.channels[r / Plant::kChannels * kColumns + 1 + r % Plant::kChannels].values[row] = readings[r];
    }
    command_at(row);
    for (int k = 0; k < steps; ++k) {
      plant.step(state, driven);
    }
  }
  return outputs;
}

template <class Plant>
double arm_of(const typename Plant::Parameters& parameters, const std::string& axis) {
  const std::vector<std::string> axes = axis_names(Plant::kEngines);
  const auto found = std::find(axes.begin(), axes.end(), axis);
  if (found == axes.end()) {
    throw UsageError(fmt::format("--axis {}: the model has no such axis; allowed: {}", axis, fmt::join(axes, ", ")));
  }
  const auto index = static_cast<std::size_t>(found - axes.begin());
  const std::size_t pitch = index - index % 2;
  const model::EngineGeometry<double> geometry(parameters.attach[pitch], parameters.attach[pitch + 1]);
  return geometry.at(0.0, 0.0).arm[index % 2][index % 2];
}

}  // namespace

Record simulate(const VehicleFile& model, const Record& inputs) {
  if (const auto* taos = std::get_if<TaosParameters>(&model.parameters)) {
    return run_vehicle<model::Taos<double>>(*taos, inputs);
  }
  return run_vehicle<model::Masv<double>>(std::get<MasvParameters>(model.parameters), inputs);
}

double moment_arm_of(const VehicleFile& model, const std::string& axis) {
  if (const auto* taos = std::get_if<TaosParameters>(&model.parameters)) {
    return arm_of<model::Taos<double>>(*taos, axis);
  }
  return arm_of<model::Masv<double>>(std::get<MasvParameters>(model.parameters), axis);
}

}  // namespace hotfire
