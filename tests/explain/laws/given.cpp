// SPDX-License-Identifier: Apache-2.0
#include "tests/explain/laws/given.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "tests/explain/readings.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire::test {

namespace {

constexpr double kPistonNoise = 8e-6;
constexpr double kEngineNoise = 6e-5;
constexpr double kPeriod = 4e-3;
/// Commands are held for so many rows, so that a record of half the rate has the same.
constexpr std::size_t kHeldRows = 2;

ModelFile declared() {
  ModelFile model;
  model.name = "small";
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", kPistonNoise}, {"engine", kEngineNoise}};
  model.tolerance = {{"servovalve.position_gain", 0.03}, {"engine.inertia", 0.02}, {"structure.stiffness", 0.05}};
  return model;
}

/// The rig as it is, but for what is missing: declared values are off by a part of their tolerances.
ModelFile rig() {
  ModelFile truth = declared();
  auto& parameters = std::get<SimplexParameters>(truth.parameters);
  parameters.servovalve.position_gain *= 1.01;
  parameters.engine.inertia *= 0.99;
  return truth;
}

Record recorded(const ModelFile& truth, const char* name, double seconds, double (*command_at)(double), unsigned seed) {
  Record record;
  record.name = name;
  record.path = name;
  record.period = kPeriod;
  record.rows = static_cast<std::size_t>(std::lround(seconds / kPeriod));
  Channel command{"command", "rad", {}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    const std::size_t held_since = row - row % kHeldRows;
    command.values.push_back(command_at(static_cast<double>(held_since) * kPeriod));
  }
  record.channels.push_back(std::move(command));
  const Record modelled = simulate(truth, record);
  std::mt19937_64 random(seed);
  add_readings(record, modelled, {{"piston", kPistonNoise}, {"engine", kEngineNoise}}, random);
  return record;
}

/// A swept sine of 9 mrad from 0.2 to 4 Hz, about a slow motion.
double sweep(double t) {
  const double slow = 6e-3 * std::sin(2.0 * std::numbers::pi * 0.13 * t);
  return t < 0.4 ? 0.0 : slow + 9e-3 * std::sin(2.0 * std::numbers::pi * (0.2 + 0.19 * (t - 0.4)) * (t - 0.4));
}

/// Steps to both sides, each to another height.
double steps(double t) {
  constexpr double kHeights[] = {0.0, 8e-3, -4e-3, 1.4e-2, -1.2e-2, 3e-3, -8e-3, 1e-2, -1.5e-2, 0.0};
  return kHeights[static_cast<std::size_t>(t / 1.2) % std::size(kHeights)];
}

Given recorded_of(const ModelFile& truth) {
  return {declared(), {recorded(truth, "sweep.csv", 12.0, sweep, 7), recorded(truth, "steps.csv", 12.0, steps, 8)}};
}

/// The rig with one effect: its values are set by `set`.
template <class E, class Set>
ModelFile rig_with(Set&& set) {
  ModelFile truth = rig();
  add_effect<E>(std::get<SimplexParameters>(truth.parameters), set);
  return truth;
}

/// The valve gives a tenth more on extend than it should, and a tenth less on retract.
Given asymmetric() {
  return recorded_of(rig_with<model::ValveAsymmetry>([](auto& values) { values.asymmetry = 0.1; }));
}

/// A torque to one side that grows with the square of the engine's angle.
Given bowed() {
  return recorded_of(rig_with<model::Term<model::Site::engine_torque>>([](auto& values) {
    constexpr double kTorque = 8e3;
    constexpr double kAngle = 0.02;
    values.argument = static_cast<int>(model::Argument::angle);
    values.factor = 1 + static_cast<int>(model::Argument::angle);
    values.gain = kTorque / (kAngle * kAngle);
  }));
}

Given whole() { return recorded_of(rig()); }

Given soft() {
  return recorded_of(rig_with<model::SoftStiffness>([](auto& values) {
    values.option = static_cast<int>(model::SoftStiffness::Law::saturation);
    values.low_stiffness = 3e7;
    values.load_scale = 1e4;
  }));
}

}  // namespace

const LawCase kListed{"valve_asymmetry", asymmetric, "valve_asymmetry", "valve"};
const LawCase kUnlisted{"a torque over the angle", bowed, "unlisted", "engine_torque"};
const LawCase kNull{"nothing missing", whole, nullptr, nullptr};
const LawCase kSoft{"soft_stiffness", soft, "soft_stiffness", "load_spring"};

}  // namespace hotfire::test
