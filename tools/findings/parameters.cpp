// SPDX-License-Identifier: Apache-2.0
#include "tools/findings/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

SimplexParameters& axis_of(ModelFile& model) {
  auto* axis = std::get_if<SimplexParameters>(&model.parameters);
  if (axis == nullptr) {
    throw FileError(
        fmt::format("{}: topology: a parameter set of the findings is one axis; allowed: \"simplex\"", model.path.string()));
  }
  return *axis;
}

ModelFile without_effects(ModelFile model) {
  axis_of(model).effects.active = {};
  return model;
}

std::vector<trials::ChannelSweep> swept(const ModelFile& model, const std::vector<double>& command, double lowest,
                                        double highest) {
  trials::SweepGoal goal;
  goal.moment_arm = moment_arm_of(model);
  goal.lowest = lowest;
  goal.highest = highest;
  return trials::analyse_sweep(simulate(model, trials::command_record(command)), goal);
}

std::vector<trials::ChannelSweep> swept(const VehicleFile& model, const std::string& axis,
                                        const std::vector<double>& command, double lowest, double highest) {
  trials::SweepGoal goal;
  goal.axis = axis;
  goal.moment_arm = moment_arm_of(model, axis);
  goal.lowest = lowest;
  goal.highest = highest;
  return trials::analyse_sweep(simulate(model, trials::command_record(command, "command." + axis)), goal);
}

GreenRun green_run(const VehicleFile& model, const Record& record, const std::string& axis) {
  trials::SweepGoal goal;
  goal.axis = axis;
  goal.moment_arm = moment_arm_of(model, axis);
  goal.lowest = 5.0;
  goal.highest = 14.0;
  const auto sweeps = trials::analyse_sweep(record, goal);
  return {trials::joined_sweep(sweeps, "piston", goal), trials::joined_sweep(sweeps, "engine", goal)};
}

Record pitch_steps() {
  return trials::command_record(trials::steps({trials::radians(0.6), trials::radians(0.4), trials::radians(0.2)}, 2.0),
                                "command.pitch");
}

std::vector<analysis::StepResponse> engine_steps(const Record& command, const Record& response) {
  return analysis::step_responses(command.find("command.pitch")->values, response.find("engine.pitch")->values,
                                  response.period, 1.0);
}

double notch_of(const trials::ChannelSweep& sweep) { return sweep.notch ? sweep.notch->frequency : kNone; }

double phase_between(const trials::ChannelSweep& sweep, const trials::ChannelSweep& other, double frequency) {
  return std::arg(nearest(sweep, frequency).gain / nearest(other, frequency).gain) * 180.0 / std::numbers::pi;
}

double gain_between(const trials::ChannelSweep& sweep, const trials::ChannelSweep& other, double frequency) {
  return analysis::gain_decibels(nearest(sweep, frequency)) - analysis::gain_decibels(nearest(other, frequency));
}

const analysis::ResponsePoint& nearest(const trials::ChannelSweep& sweep, double frequency) {
  return *std::min_element(sweep.response.begin(), sweep.response.end(), [frequency](const auto& a, const auto& b) {
    return std::abs(a.frequency - frequency) < std::abs(b.frequency - frequency);
  });
}

}  // namespace hotfire::findings
