// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/files/text/error.hpp"

namespace hotfire::loop {

namespace {

std::size_t place_of(const std::vector<plant::Variable>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const plant::Variable& own) { return own.name == name; });
  if (found == all.end()) {
    throw UsageError("the plant has no signal " + name + "; allowed topology: masv");
  }
  return static_cast<std::size_t>(found - all.begin());
}

}  // namespace

FlightRecord fly(const plant::AnyParameters& parameters, const Stage& stage, const Controller& controller,
                 const FlightPlan& plan) {
  if (controller.is_measured()) {
    throw UsageError("a measured frequency response is no law in time; remedy: --no-simulation, or gain and filters");
  }
  plant::Setup setup;
  setup.period = controller.period;
  const int steps = plant::make_plant(parameters, setup)->steps();
  setup.period = controller.period / steps;
  const auto plant = plant::make_plant(parameters, setup);
  const double h = setup.period;
  const auto delay = static_cast<int>(std::lround(controller.delay / h));
  std::vector<std::size_t> commands;
  std::vector<std::size_t> engines;
  for (int i = 0; i < stage.axes(); ++i) {
    if (axis_name(i).starts_with(controller.axis)) {
      commands.push_back(place_of(plant->inputs(), "command." + axis_name(i)));
    }
    engines.push_back(place_of(plant->outputs(), "engine." + axis_name(i)));
  }
  plant->start(0.0);
  const auto angles = [&] {
    Eigen::VectorXd all(stage.axes());
    for (int i = 0; i < stage.axes(); ++i) {
      all(i) = plant->output_values()[engines[static_cast<std::size_t>(i)]];
    }
    return all;
  };
  const Eigen::VectorXd rest = angles();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(stage.axes());
  const Stage::Step step = stage.step(h);
  Eigen::VectorXd state = stage.turned(plan.attitude);
  const Controller::Law law = controller.law();
  Eigen::VectorXd memory = Eigen::VectorXd::Zero(law.a.rows());
  std::vector<double> given(static_cast<std::size_t>(delay) + 1, 0.0);  // commands of the steps that are on their way
  FlightRecord record;
  constexpr double kRunaway = 1.0;  // rad
  const auto samples = static_cast<int>(std::ceil(plan.seconds / controller.period));
  for (int sample = 0; sample < samples; ++sample) {
    const Eigen::Vector2d read = step.read * state;
    const double command = -(law.c.dot(memory) + law.d.dot(read));
    memory = (law.a * memory + law.b * read).eval();
    record.time.push_back(sample * controller.period);
    record.command.push_back(command);
    record.attitude.push_back(read(0));
    record.ran_away = !(std::abs(read(0)) < kRunaway);
    if (record.ran_away) {
      return record;
    }
    for (int k = 0; k < steps; ++k) {
      const auto now = static_cast<std::size_t>(sample * steps + k) % given.size();
      given[now] = command;
      const double acting = given[(now + 1) % given.size()];
      for (const std::size_t own : commands) {
        plant->input_values()[own] = acting;
      }
      if (!plant->advance()) {
        record.ran_away = true;
        return record;
      }
      const Eigen::VectorXd after = angles() - rest;
      state = (step.by_state * state + step.by_angle * (0.5 * (before + after))).eval();
      before = after;
    }
  }
  return record;
}

}  // namespace hotfire::loop
