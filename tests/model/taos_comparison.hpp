#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/model/reference_taos.hpp"
#include "tests/model/vehicles.hpp"

namespace hotfire::test {

// One engine and the independent reference, told the same and run on the same commands.

using Rows = std::vector<std::array<double, 4>>;

inline constexpr double kSample = 1e-3;
inline constexpr int kSamples = 1200;
/// Sines from 1 to 9 Hz about both angles, a step up in pitch and one down in yaw, 0.3 deg each.
inline std::vector<std::array<double, 2>> command_profile() {
  constexpr double degree = std::numbers::pi / 180.0;
  const auto sine = [](double frequency, double t) { return std::sin(2.0 * std::numbers::pi * frequency * t); };
  std::vector<std::array<double, 2>> commands;
  for (int i = 0; i < kSamples; ++i) {
    const double t = i * kSample;
    commands.push_back({degree * (0.5 * sine(1.0, t) + 0.25 * sine(4.0, t) + 0.15 * sine(9.0, t) + (t >= 0.5 ? 0.3 : 0.0)),
                        degree * (0.4 * sine(1.3, t) + 0.2 * sine(6.0, t) - (t >= 0.8 ? 0.3 : 0.0))});
  }
  return commands;
}

/// Three modes around the loaded resonance and one above, that turn the gimbal as well.
inline Taos::Modes four_modes() {
  Taos::Modes modes;
  modes.modes = 4;
  modes.frequency = {4.2, 8.1, 11.7, 26.0};
  modes.damping_ratio = {0.01, 0.015, 0.01, 0.02};
  modes.shape.col(0) << 1.0e-3, -4.0e-4, 2.0e-4, 1.0e-4;
  modes.shape.col(1) << 1.5e-3, 9.0e-4, -3.0e-4, 2.0e-4;
  modes.shape.col(2) << -8.0e-4, 1.6e-3, 1.0e-4, 4.0e-4;
  modes.shape.col(3) << 2.0e-3, 1.2e-3, 5.0e-4, -6.0e-4;
  return modes;
}

/// The same engine, told to the reference.
inline ReferenceTaos reference_of(const Taos::Parameters& parameters, const Taos& plant) {
  ReferenceTaos taos;
  for (int i = 0; i < 2; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto& axis = parameters.axes[k];
    ReferenceAxis& reference = taos.axes[k];
    reference.arm = plant.axis(i).parameters().actuator.moment_arm;
    reference.load_stiffness = axis.structure.stiffness;
    reference.damping = axis.engine.viscous_damping;
    reference.duct_stiffness = axis.engine.duct_stiffness;
    if (axis.effects.active[index_in<model::SoftStiffness>(Taos::Effects{})]) {
      const auto& soft = std::get<index_in<model::SoftStiffness>(Taos::Effects{})>(axis.effects.values);
      reference.soft = ReferenceAxis::Soft::compliance;
      reference.low_stiffness = soft.low_stiffness;
      reference.load_scale = soft.load_scale;
    }
    if (axis.effects.active[index_in<model::ValveDeadband>(Taos::Effects{})]) {
      reference.deadband = std::get<index_in<model::ValveDeadband>(Taos::Effects{})>(axis.effects.values).half_width;
    }
    taos.on_engine[k] = parameters.attach[k].engine();
    taos.on_vehicle[k] = parameters.attach[k].vehicle();
  }
  const auto& gimbal = parameters.gimbals[0];
  taos.thrust = gimbal.bearing.thrust;
  taos.loss_time = gimbal.bearing.loss_time;
  if (gimbal.compliant) {
    taos.bearing_compliance = gimbal.stiffness.inverse();
  }
  const auto& law = gimbal.friction;
  if (law.coulomb_torque > 0.0) {
    const bool vibrated = law.option == model::BearingFriction<double>::kVibrated;
    const double least = vibrated ? law.coulomb_torque * law.vibration_ratio : law.coulomb_torque;
    taos.friction = {law.coulomb_torque,    law.stiffness, law.static_ratio,
                     law.stribeck_velocity, law.damping,   2.0 * std::sqrt(2.0 * std::numbers::e) * least / law.damping};
    taos.vibration_ratio = vibrated ? law.vibration_ratio : 1.0;
    taos.vibration_velocity = law.vibration_velocity;
  }
  for (int k = 0; k < parameters.modes.modes; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const auto shape = parameters.modes.shape.col(k);
    taos.modes.push_back({parameters.modes.frequency[mode],
                          parameters.modes.damping_ratio[mode],
                          {shape(0), shape(1)},
                          {shape(2), shape(3)}});
  }
  return taos;
}

inline ReferenceTaos::Start start_of(const Taos::State& state, int modes) {
  ReferenceTaos::Start start;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::copy(state.axes[axis].y.begin(), state.axes[axis].y.end(), start.axes[axis].begin());
  }
  std::copy(state.gimbals[0].displacement.begin(), state.gimbals[0].displacement.end(), start.bearing.begin());
  for (int k = 0; k < modes; ++k) {
    start.modes.push_back(state.structure.modes[static_cast<std::size_t>(k)].displacement);
  }
  return start;
}

/// The model from a start on the commands, `parts` steps a sample.
inline Rows run_model(const Taos& plant, Taos::State state, int parts) {
  Rows rows;
  for (const auto& commands : command_profile()) {
    for (int part = 0; part < parts; ++part) {
      plant.step(state, {commands, {}});
    }
    const auto& measured = Taos::measured(state);
    rows.push_back({measured[0], measured[1], measured[3], measured[4]});
  }
  return rows;
}

inline Rows run_model(const Taos::Parameters& parameters, int parts) {
  const Taos plant(parameters, kSample / parts);
  return run_model(plant, plant.steady({}), parts);
}

/// The reference from the model's steady state.
inline Rows run_reference(const Taos::Parameters& parameters) {
  const Taos plant(parameters, kSample);
  return integrate_reference(reference_of(parameters, plant), start_of(plant.steady({}), parameters.modes.modes),
                             command_profile(), kSample);
}

}  // namespace hotfire::test
