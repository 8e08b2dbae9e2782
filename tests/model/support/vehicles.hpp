// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "model/vehicle.hpp"
#include "tests/model/support/plants.hpp"

namespace hotfire::test {

using Taos = model::Taos<double>;
using Masv = model::Masv<double>;

/// Makes effect E active in the axis `axis` of a vehicle's parameters.
template <class E, class Vehicle>
void activate_in(typename Vehicle::Parameters& parameters, int axis, const ParamsOf<E, double>& values) {
  constexpr std::size_t index = index_in<E>(typename Vehicle::Effects{});
  auto& effects = parameters.axes[static_cast<std::size_t>(axis)].effects;
  std::get<index>(effects.values) = values;
  effects.active[index] = true;
}

/// A bearing of titanium's order: 2e9 N/m in translation, 1.7e7 N.m/rad in torsion, and a twentieth of the geometric mean
/// between sideways forces and the torsion they cause.
inline Eigen::Matrix<double, 6, 6> bearing_stiffness() {
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  for (int i = 0; i < 3; ++i) {
    stiffness(i, i) = 2e9;
    stiffness(3 + i, 3 + i) = 1.7e7;
  }
  const double cross = 0.05 * std::sqrt(2e9 * 1.7e7);
  stiffness(1, 5) = stiffness(5, 1) = cross;
  stiffness(2, 4) = stiffness(4, 2) = -cross;
  return stiffness;
}

/// Attach points whose lines are inclined, so that every arm follows both angles.
inline model::AttachPoints<double> inclined_pitch() { return {-0.35, 0.05, -0.70, 0.85, 0.0, -0.95}; }
inline model::AttachPoints<double> inclined_yaw() { return {-0.35, 0.70, 0.05, 0.85, 0.95, 0.0}; }

/// Hot fire with everything the papers found: thrust, LuGre friction over both angles on a compliant bearing, actuators soft
/// under small loads, valves with lap, inclined attach points; representative numbers.
template <class Vehicle>
typename Vehicle::Parameters hot_fire() {
  typename Vehicle::Parameters parameters;
  for (int i = 0; i < Vehicle::kAxes; ++i) {
    parameters.axes[static_cast<std::size_t>(i)].structure.stiffness = 1.05e8;
    activate_in<model::SoftStiffness, Vehicle>(parameters, i, {0, 4e7, 8e3, {}});
    activate_in<model::ValveDeadband, Vehicle>(parameters, i, {0, 0.02});
    parameters.attach[static_cast<std::size_t>(i)] = i % 2 == 0 ? inclined_pitch() : inclined_yaw();
  }
  for (auto& gimbal : parameters.gimbals) {
    gimbal.bearing.thrust = 1.86e6;
    gimbal.bearing.loss_time = 1e-3;
    gimbal.compliant = true;
    gimbal.stiffness = bearing_stiffness();
    gimbal.friction = {2, 15e3, 1e8, 1.2, 0.01, 3e3, 1.0, 0.01};
  }
  return parameters;
}

/// `count` modes from 1 to 40 Hz with a damping ratio of 1 %, shapes of either sign; seeded. Together they give an attach
/// point a static flexibility of about `flexibility` [m/N].
template <class Modes>
Modes random_modes(int count, double flexibility, unsigned seed) {
  Random random(seed);
  Modes modes;
  modes.modes = count;
  for (int k = 0; k < count; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    modes.frequency[mode] = 1.0 + 39.0 * (k + random.uniform(0.1, 0.9)) / count;
    modes.damping_ratio[mode] = 0.01;
    const double w = 2.0 * std::numbers::pi * modes.frequency[mode];
    const double size = w * std::sqrt(flexibility / count);
    for (int port = 0; port < Modes::kPorts; ++port) {
      const double lever = port < Modes::kPorts / 2 ? 1.0 : 0.3;  // rotations: per metre, and of the stiffer mount
      modes.shape(port, k) = lever * size * random.uniform(-1.7, 1.7);
    }
  }
  return modes;
}

}  // namespace hotfire::test
