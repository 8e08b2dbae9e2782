// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/model/support/plants.hpp"
#include "tools/study/reference/reference_axis.hpp"

namespace hotfire::test {

// One axis and the independent reference, told the same and run on the same commands.

inline constexpr double kAxisSample = 1e-3;

/// The same axis told twice.
struct AxisCase {
  const char* name = "";
  study::ReferenceAxis reference{};
  model::Simplex<double>::Parameters parameters{};
  double settling = 0.0;
};

/// 1.5 s of command: sines from 1 to 9 Hz and two steps, 0.3 deg each, so that friction sticks, breaks away and turns round.
inline std::vector<double> axis_commands() {
  constexpr double degree = std::numbers::pi / 180.0;
  std::vector<double> commands;
  for (int i = 0; i < 1500; ++i) {
    const double t = i * kAxisSample;
    const double sines = 0.5 * std::sin(2.0 * std::numbers::pi * t) + 0.25 * std::sin(2.0 * std::numbers::pi * 4.0 * t) +
                         0.15 * std::sin(2.0 * std::numbers::pi * 9.0 * t);
    commands.push_back(degree * (sines + (t >= 0.5 ? 0.3 : 0.0) - (t >= 1.1 ? 0.3 : 0.0)));
  }
  return commands;
}

/// Piston, engine and load pressure of the model from its steady state on the commands, `parts` steps a sample.
inline study::ReferenceRows run_axis(const model::Simplex<double>::Parameters& parameters, int parts) {
  using Plant = model::Simplex<double>;
  const Plant plant(parameters, kAxisSample / parts);
  Plant::State state = plant.steady(0.0);
  study::ReferenceRows rows;
  for (const double command : axis_commands()) {
    for (int part = 0; part < parts; ++part) {
      plant.step(state, command);
    }
    rows.push_back({state.y(Plant::kPiston), state.y(Plant::kAngle), state.y(Plant::kPressure)});
  }
  return rows;
}

/// LuGre at the gimbal on both sides. v_d is half of the bound in physics.md section 3.
inline void add_lugre(AxisCase& test, double level, double stiffness, double ratio, double stribeck, double damping) {
  activate<model::GimbalFriction, model::Simplex<double>>(
      test.parameters, {option_named<model::GimbalFriction>("lugre"), level, stiffness, ratio, stribeck, damping});
  const double dies_at = damping > 0.0 ? 2.0 * std::sqrt(2.0 * std::numbers::e) * level / damping : 1.0;
  test.reference.bristle = {level, stiffness, ratio, stribeck, damping, dies_at};
}

inline void add_soft(AxisCase& test, double low, double scale) {
  activate<model::SoftStiffness, model::Simplex<double>>(test.parameters,
                                                         {option_named<model::SoftStiffness>("compliance"), low, scale, {}});
  test.reference.soft = study::ReferenceAxis::Soft::compliance;
  test.reference.low_stiffness = low;
  test.reference.load_scale = scale;
}

inline void add_deadband(AxisCase& test, double half_width) {
  activate<model::ValveDeadband, model::Simplex<double>>(test.parameters, {0, half_width});
  test.reference.deadband = half_width;
}

/// An axis with the effects that an axis of the vehicle and its bearing have.
inline AxisCase hot_fire_axis() {
  AxisCase test{"friction, soft spring, dead band"};
  add_lugre(test, 15e3, 1e8, 1.2, 0.01, 3e3);
  add_soft(test, 4e7, 8e3);
  add_deadband(test, 0.02);
  return test;
}

}  // namespace hotfire::test
