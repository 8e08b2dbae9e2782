// SPDX-License-Identifier: Apache-2.0
#include "tools/project/example_records.hpp"

#include <map>
#include <random>
#include <utility>

#include "tools/files/record/axis_names.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire {

namespace {

/// How an input channel of a kind is driven.
struct Excitation {
  std::vector<std::string> channels;
  std::string unit;
  std::vector<double> steps;  ///< amplitudes, in the unit
  double peak = 0.0;          ///< of the multisine
  double highest = 0.0;       ///< frequency of it [Hz]
};

constexpr double kHold = 1.0;     ///< of a step [s]
constexpr double kLowest = 0.2;   ///< frequency of the multisine [Hz]
constexpr double kLength = 10.0;  ///< of one of its periods [s]
constexpr int kRepeats = 2;
constexpr double kRest = 0.5;  ///< before anything moves [s]

Excitation excitation_of(const std::string& kind) {
  using trials::radians;
  if (kind == "direct") {
    return {{"force"}, "N", {60.0, 120.0, 240.0}, 300.0, 5.0};
  }
  const std::vector<double> steps{radians(0.2), radians(0.6), radians(2.0)};
  if (kind == "taos") {
    return {{"command.pitch", "command.yaw"}, "rad", steps, radians(1.5), 8.0};
  }
  return {{"command"}, "rad", steps, radians(1.5), 8.0};
}

/// An input that rests before it begins: a record says most of where it starts if nothing moves there.
std::vector<double> after_rest(const std::vector<double>& values) {
  std::vector<double> all(static_cast<std::size_t>(kRest / trials::kPeriod), 0.0);
  all.insert(all.end(), values.begin(), values.end());
  return all;
}

Record inputs_of(const Excitation& excitation, bool are_steps) {
  Record record = trials::command_record({});
  record.channels.clear();
  unsigned seed = 1;
  for (const std::string& channel : excitation.channels) {
    const std::vector<double> values =
        are_steps ? trials::steps(excitation.steps, kHold)
                  : trials::multisine(excitation.peak, kLowest, excitation.highest, kLength, kRepeats, seed);
    record.channels.push_back({channel, excitation.unit, after_rest(values)});
    ++seed;
  }
  if (are_steps && excitation.channels.size() > 1) {
    // One axis after the other: what one of them does to the other shows.
    std::vector<double>& first = record.channels.front().values;
    std::vector<double>& second = record.channels.back().values;
    const std::size_t rows = first.size();
    first.resize(2 * rows, 0.0);
    second.insert(second.begin(), rows, 0.0);
  }
  record.rows = record.channels.front().values.size();
  return record;
}

/// What a rig measures of a simulation: channels with declared noise, each value with it, and the inputs as they are.
void measure(Record& record, const std::map<std::string, double>& noise, const Excitation& excitation,
             std::mt19937_64& random) {
  std::erase_if(record.channels, [&](const Channel& channel) {
    const bool is_input = std::ranges::find(excitation.channels, channel.name) != excitation.channels.end();
    return !is_input && !noise.contains(std::string(own_name(channel.name)));
  });
  for (Channel& channel : record.channels) {
    const auto found = noise.find(std::string(own_name(channel.name)));
    if (found == noise.end()) {
      continue;
    }
    std::normal_distribution<double> error(0.0, found->second);
    for (double& value : channel.values) {
      value += error(random);
    }
  }
}

}  // namespace

ExampleEffect example_effect(const std::string& kind) {
  if (kind == "direct") {
    return {"sliding friction (`sliding_friction`)",
            "\n[effects.sliding_friction]\nlaw = \"coulomb\"\ncoulomb_forward = 21\ncoulomb_backward = 21\n"};
  }
  if (kind == "taos") {
    return {"a dead band of the pitch servovalve (`valve_deadband`)",
            "\n[effects.valve_deadband.pitch]\nhalf_width = 0.02\n"};
  }
  return {"friction of the gimbal (`gimbal_friction`)",
          "\n[effects.gimbal_friction]\nlaw = \"lugre\"\ncoulomb_torque = 9e3\n"};
}

std::vector<ExampleRecord> example_records(const std::string& declared, const std::string& kind) {
  const std::string rig = declared + example_effect(kind).toml;
  const Excitation excitation = excitation_of(kind);
  std::mt19937_64 random(1);
  std::vector<ExampleRecord> examples;
  for (const auto& [file, are_steps] : {std::pair{"steps.csv", true}, std::pair{"multisine.csv", false}}) {
    const Record inputs = inputs_of(excitation, are_steps);
    Record outputs;
    if (is_vehicle(rig, kind)) {
      const VehicleFile model = parse_vehicle(rig, kind);
      outputs = simulate(model, inputs);
      measure(outputs, model.axes.front().noise, excitation, random);
    } else {
      const ModelFile model = parse_model(rig, kind);
      outputs = simulate(model, inputs);
      measure(outputs, model.noise, excitation, random);
    }
    examples.push_back({file, std::move(outputs)});
  }
  return examples;
}

}  // namespace hotfire
