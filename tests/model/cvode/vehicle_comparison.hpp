// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/model/cvode/reference_vehicle.hpp"
#include "tests/model/support/vehicles.hpp"

namespace hotfire::test {

// Engines on a structure and the independent reference, told the same and run on the same commands.

using VehicleRows = std::vector<std::vector<double>>;
using Drive = std::vector<ReferenceVehicle::Inputs>;

inline constexpr double kSample = 1e-3;
inline constexpr int kSamples = 1200;

/// Sines from 1 to 9 Hz about both angles, a step up in pitch and one down in yaw, 0.3 deg each. Every further engine is
/// commanded the same a little later and the other way round. All of it times `size_of_all`.
template <class Vehicle>
Drive command_profile(double size_of_all = 1.0) {
  const double degree = size_of_all * std::numbers::pi / 180.0;
  const auto sine = [](double frequency, double t) { return std::sin(2.0 * std::numbers::pi * frequency * t); };
  Drive drive;
  for (int i = 0; i < kSamples; ++i) {
    std::vector<double> row;
    for (int engine = 0; engine < Vehicle::kEngines; ++engine) {
      const double t = i * kSample - 0.02 * engine;
      const double size = t < 0.0 ? 0.0 : engine % 2 == 0 ? degree : -degree;
      row.push_back(size * (0.5 * sine(1.0, t) + 0.25 * sine(4.0, t) + 0.15 * sine(9.0, t) + (t >= 0.5 ? 0.3 : 0.0)));
      row.push_back(size * (0.4 * sine(1.3, t) + 0.2 * sine(6.0, t) - (t >= 0.8 ? 0.3 : 0.0)));
    }
    drive.push_back({row});
  }
  return drive;
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

/// One axis, told to the reference.
template <class Vehicle>
ReferenceAxis reference_axis_of(const typename Vehicle::AxisModel::Parameters& axis, double arm) {
  constexpr std::size_t soft_stiffness = index_in<model::SoftStiffness>(typename Vehicle::Effects{});
  constexpr std::size_t deadband = index_in<model::ValveDeadband>(typename Vehicle::Effects{});
  constexpr std::size_t cross_axis = index_in<model::CrossAxis>(typename Vehicle::Effects{});
  ReferenceAxis reference;
  reference.arm = arm;
  reference.load_stiffness = axis.structure.stiffness;
  reference.damping = axis.engine.viscous_damping;
  reference.duct_stiffness = axis.engine.duct_stiffness;
  if (axis.effects.active[soft_stiffness]) {
    const auto& soft = std::get<soft_stiffness>(axis.effects.values);
    reference.soft = ReferenceAxis::Soft::compliance;
    reference.low_stiffness = soft.low_stiffness;
    reference.load_scale = soft.load_scale;
  }
  if (axis.effects.active[deadband]) {
    reference.deadband = std::get<deadband>(axis.effects.values).half_width;
  }
  if (axis.effects.active[cross_axis]) {
    const auto& cross = std::get<cross_axis>(axis.effects.values);
    reference.cross_stiffness = cross.stiffness;
    reference.cross_damping = cross.damping;
  }
  return reference;
}

inline void tell_gimbal(const model::GimbalParameters<double>& gimbal, ReferenceVehicle::Engine& engine) {
  using Law = model::BearingFriction<double>::Law;
  const auto& bearing = gimbal.bearing;
  engine.thrust = bearing.thrust;
  engine.rated_thrust = bearing.rated_thrust;
  engine.dead_load = bearing.dead_load;
  engine.misalignment = {bearing.pitch_misalignment, bearing.yaw_misalignment};
  engine.unloaded_structure = bearing.unloaded_structure;
  engine.loss_time = bearing.loss_time;
  engine.unloaded_stiffness = bearing.unloaded_stiffness;
  engine.seat_scale = bearing.load_scale;
  if (gimbal.compliant) {
    engine.bearing_compliance = gimbal.stiffness.inverse();
    engine.block_mass = bearing.block_mass;
    engine.block_inertia = bearing.block_inertia;
    engine.vehicle_side = bearing.vehicle_side_flexibility;
    const std::array<int, 5> moving{0, 1, 2, 4, 5};
    engine.block_stiffness = (engine.vehicle_side * engine.bearing_compliance(moving, moving)).inverse();
  }
  const auto& law = gimbal.friction;
  const bool dahl = law.law() == Law::dahl;
  engine.friction = {law.coulomb_torque,
                     law.coefficient,
                     law.radius,
                     law.stiffness,
                     dahl ? 1.0 : law.static_ratio,
                     law.stribeck_velocity,
                     dahl ? 0.0 : law.damping,
                     law.law() == Law::vibrated_lugre ? law.vibration_ratio : 1.0,
                     law.vibration_velocity,
                     law.viscous,
                     dahl ? law.exponent : 1.0};
}

/// The same vehicle, told to the reference.
template <class Vehicle>
ReferenceVehicle reference_of(const typename Vehicle::Parameters& parameters, const Vehicle& plant) {
  ReferenceVehicle vehicle;
  for (std::size_t e = 0; e < Vehicle::kEngines; ++e) {
    ReferenceVehicle::Engine engine;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t i = 2 * e + k;
      const double arm = plant.axis(static_cast<int>(i)).parameters().actuator.moment_arm;
      engine.axes[k] = reference_axis_of<Vehicle>(parameters.axes[i], arm);
      engine.on_engine[k] = parameters.attach[i].engine();
      engine.on_vehicle[k] = parameters.attach[i].vehicle();
    }
    engine.declared_arms = parameters.constant_arms[e];
    tell_gimbal(parameters.gimbals[e], engine);
    vehicle.engines.push_back(engine);
  }
  for (int k = 0; k < parameters.modes.modes; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const auto shape = parameters.modes.shape.col(k);
    vehicle.modes.push_back({parameters.modes.frequency[mode],
                             parameters.modes.damping_ratio[mode],
                             {shape.begin(), shape.begin() + Vehicle::kAxes},
                             {shape.begin() + Vehicle::kAxes, shape.end()}});
  }
  return vehicle;
}

template <class State>
ReferenceVehicle::Start start_of(const State& state, int modes) {
  ReferenceVehicle::Start start;
  for (std::size_t e = 0; e < state.gimbals.size(); ++e) {
    ReferenceVehicle::Start::Engine engine;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& y = state.axes[2 * e + k].y;
      std::copy(y.begin(), y.end(), engine.axes[k].begin());
    }
    const auto& bearing = state.gimbals[e].bearing;
    std::copy(bearing.displacement.begin(), bearing.displacement.end(), engine.bearing.begin());
    const auto& block = bearing.block.displacement;
    // In space: the vehicle's side turns with the modes.
    const auto port = static_cast<Eigen::Index>(state.axes.size() + 2 * e);
    const auto turned = state.structure.displacement.template segment<2>(port);
    engine.block = {block(0), block(1), block(2), block(3) + turned(0), block(4) + turned(1)};
    start.engines.push_back(engine);
  }
  for (int k = 0; k < modes; ++k) {
    start.modes.push_back(state.structure.modes[static_cast<std::size_t>(k)].displacement);
  }
  return start;
}

/// Inputs of the model over a sample of the reference.
template <class Vehicle>
typename Vehicle::Inputs inputs_of(const ReferenceVehicle::Inputs& drive) {
  typename Vehicle::Inputs inputs;
  std::copy(drive.commands.begin(), drive.commands.end(), inputs.commands.begin());
  std::copy(drive.thrust.begin(), drive.thrust.end(), inputs.thrust.begin());
  std::copy(drive.force.begin(), drive.force.end(), inputs.force.begin());
  std::copy(drive.torque.begin(), drive.torque.end(), inputs.torque.begin());
  return inputs;
}

/// The steady state under the thrust of the first sample, uncommanded.
template <class Vehicle>
typename Vehicle::State start_of_drive(const Vehicle& plant, const Drive& drive) {
  return plant.steady({}, inputs_of<Vehicle>(drive.front()).thrust);
}

/// The model from a start, `parts` steps a sample.
template <class Vehicle>
VehicleRows run_model(const Vehicle& plant, typename Vehicle::State state, int parts,
                      const Drive& drive = command_profile<Vehicle>()) {
  VehicleRows rows;
  for (const ReferenceVehicle::Inputs& sample : drive) {
    const auto inputs = inputs_of<Vehicle>(sample);
    for (int part = 0; part < parts; ++part) {
      plant.step(state, inputs);
    }
    const auto& measured = Vehicle::measured(state);
    std::vector<double> row;
    for (std::size_t i = 0; i < Vehicle::kAxes; ++i) {
      row.insert(row.end(), {measured[i * Vehicle::kChannels], measured[i * Vehicle::kChannels + 1]});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

template <class Vehicle>
VehicleRows run_model(const typename Vehicle::Parameters& parameters, int parts,
                      const Drive& drive = command_profile<Vehicle>()) {
  const Vehicle plant(parameters, kSample / parts);
  return run_model(plant, start_of_drive(plant, drive), parts, drive);
}

/// The reference from the model's steady state.
template <class Vehicle>
VehicleRows run_reference(const typename Vehicle::Parameters& parameters, double tolerance = 1e-10,
                          const Drive& drive = command_profile<Vehicle>()) {
  const Vehicle plant(parameters, kSample);
  return integrate_reference(reference_of(parameters, plant), start_of(start_of_drive(plant, drive), parameters.modes.modes),
                             drive, kSample, tolerance);
}

/// The largest error of any piston or engine, rms over the signal's rms.
inline double largest_error(const VehicleRows& rows, const VehicleRows& reference) {
  double largest = 0.0;
  for (std::size_t channel = 0; channel < reference.front().size(); ++channel) {
    largest = std::max(largest, relative_rms(rows, reference, channel));
  }
  return largest;
}

}  // namespace hotfire::test
