// SPDX-License-Identifier: Apache-2.0
// A thousand steps from random states under random commands, for callgrind to count: step_cost.cmake runs it.

#include <cstdio>

#include "tests/model/cost/disturbed.hpp"
#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Plant = model::Simplex<double>;

constexpr std::size_t kFriction = index_in<model::GimbalFriction>(Plant::Effects{});

Plant::Parameters three_effects() {
  Plant::Parameters parameters;
  activate<model::GimbalFriction, Plant>(parameters, {2, 45e3, 5e8, 1.2, 0.01, 1e3});
  activate<model::SoftStiffness, Plant>(parameters, typical<model::SoftStiffness, double>(0));
  activate<model::ValveDeadband, Plant>(parameters, typical<model::ValveDeadband, double>(0));
  return parameters;
}

/// A state anywhere an axis can be. Half of them are all but at rest, so that the bristle sticks.
Plant::State random_state(const Plant& plant, Random& random) {
  const auto& friction = std::get<kFriction>(plant.parameters().effects.values);
  Plant::State state = plant.steady(random.uniform(-0.05, 0.05));
  const double size = random.one_in(2) ? 1.0 : 1e-5;
  disturb(state, random, size);
  const double part = size * random.uniform(-1.0, 1.0);
  std::get<kFriction>(state.effects.values).deflection = part * friction.coulomb_torque / friction.stiffness;
  state.effects.outputs[kFriction] = part * friction.coulomb_torque;
  state.inputs(5) = part * friction.coulomb_torque;
  return state;
}

}  // namespace

// callgrind knows it by name and counts what is inside.
extern "C" __attribute__((noinline)) void hotfire_measured_step(const Plant& plant, Plant::State& state, double command);
void hotfire_measured_step(const Plant& plant, Plant::State& state, double command) { plant.step(state, command); }

namespace {

/// 0 if the states are as various as they must be for the count to mean anything.
int step_a_thousand_times() {
  const Plant plant(three_effects(), 5e-4);
  const auto& friction = std::get<kFriction>(plant.parameters().effects.values);
  Random random(11);
  int slipping = 0;
  int sticking = 0;
  int saturated = 0;
  int dead = 0;
  for (int i = 0; i < 1000; ++i) {
    Plant::State state = random_state(plant, random);
    const double command = random.uniform(-0.05, 0.05);
    hotfire_measured_step(plant, state, command);
    const double speed = std::abs(state.y(Plant::kAngleRate));
    slipping += friction.stiffness * speed * plant.step_size() > friction.coulomb_torque ? 1 : 0;
    const double error = plant.parameters().actuator.moment_arm * command - state.y(Plant::kPiston);
    sticking += friction.stiffness * speed * plant.step_size() < 1e-3 * friction.coulomb_torque ? 1 : 0;
    saturated += std::abs(plant.parameters().servovalve.position_gain * error) > 1.0 ? 1 : 0;
    dead += std::abs(state.y(Plant::kOpening)) < 0.02 ? 1 : 0;
  }
  std::printf("of 1000 steps: %d stick, %d slip within one step, %d have the valve saturated, %d are in its dead band\n",
              sticking, slipping, saturated, dead);
  return sticking > 100 && slipping > 50 && saturated > 100 && saturated < 900 && dead > 100 && dead < 900 ? 0 : 1;
}

}  // namespace
}  // namespace hotfire::test

int main() { return hotfire::test::step_a_thousand_times(); }
