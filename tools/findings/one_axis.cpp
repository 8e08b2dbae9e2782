#include "tools/findings/one_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
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

GreenRun green_run(const ModelFile& model) {
  trials::SweepGoal goal;
  goal.lowest = 5.0;
  goal.highest = 14.0;
  const auto sweeps = swept(model, trials::stepped_sines(trials::green_run_sines()), goal.lowest, goal.highest);
  return {trials::joined_sweep(sweeps, "piston", goal), trials::joined_sweep(sweeps, "engine", goal)};
}

const analysis::ResponsePoint& nearest(const trials::ChannelSweep& sweep, double frequency) {
  return *std::min_element(sweep.response.begin(), sweep.response.end(), [frequency](const auto& a, const auto& b) {
    return std::abs(a.frequency - frequency) < std::abs(b.frequency - frequency);
  });
}

}  // namespace hotfire::findings
