// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/benchmark/rivals/axis_equations.hpp"
#include "tests/benchmark/rivals/fixed_step.hpp"
#include "tests/benchmark/rivals/vehicle_equations.hpp"
#include "tests/model/cvode/axis_comparison.hpp"
#include "tests/model/cvode/vehicle_comparison.hpp"

namespace hotfire::test {

// The runs of the benchmark, each as the model runs it and as equations for a general-purpose solver. A case has `System`,
// `system`, `start`, `samples`, `sample` [s], `drive(i)` and `read(x)`, and `error(rows)` against CVODE at a tolerance of
// 1e-10 on the equations that are written apart from both.

/// One axis, with friction, a soft spring and a dead band, or as declared.
template <bool WithEffects>
struct AxisRun {
  using System = AxisEquations;
  using Rows = study::ReferenceRows;
  static constexpr double sample = kAxisSample;

  AxisRun() : axis(WithEffects ? hot_fire_axis() : AxisCase{}), system(equations_of(axis.parameters)) {}
  AxisRun(const AxisRun&) = delete;
  AxisRun& operator=(const AxisRun&) = delete;

  PointOf<System> start() const { return PointOf<System>::Zero(); }
  std::size_t samples() const { return commands.size(); }
  void drive(std::size_t i) { system.command = commands[i]; }
  static std::array<double, 3> read(const PointOf<System>& x) {
    return {x(System::kPiston), x(System::kAngle), x(System::kPressure)};
  }
  double error(const Rows& rows) const {
    static const Rows reference = study::integrate_reference(axis.reference, commands, sample, 0.0);
    return std::max(relative_rms(rows, reference, 0), relative_rms(rows, reference, 1));
  }
  static std::vector<double> scales() { return {0.01, 1.0, 1e6, 1e6, 0.01, 0.1, 0.01, 0.1, 1e-4}; }

  AxisCase axis;
  System system;
  std::vector<double> commands = axis_commands();

 private:
  static System equations_of(const AxisEquations::Parameters& parameters) {
    using Effects = model::Simplex<double>::Effects;
    const auto& values = parameters.effects.values;
    const auto& deadband = std::get<index_in<model::ValveDeadband>(Effects{})>(values);
    return {&parameters,
            WithEffects ? deadband.half_width : 0.0,
            std::get<index_in<model::SoftStiffness>(Effects{})>(values),
            WithEffects,
            std::get<index_in<model::GimbalFriction>(Effects{})>(values),
            WithEffects};
  }
};

/// Hot fire with every effect: one engine with four modes, four engines with twelve that couple them.
template <class Vehicle>
typename Vehicle::Parameters every_effect() {
  typename Vehicle::Parameters parameters = hot_fire<Vehicle>();
  if constexpr (Vehicle::kEngines == 1) {
    parameters.modes = four_modes();
  } else {
    parameters.modes = random_modes<typename Vehicle::Modes>(12, 0.1 / 1.05e8, 7);
  }
  return parameters;
}

template <class Vehicle>
double vehicle_error(const VehicleRows& rows) {
  static const VehicleRows reference = run_reference<Vehicle>(every_effect<Vehicle>());
  return largest_error(rows, reference);
}

template <class Vehicle, int Modes>
struct VehicleRun {
  static constexpr int kEngines = Vehicle::kEngines;
  using System = VehicleEquations<kEngines, Modes>;
  using Rows = VehicleRows;
  static constexpr double sample = kSample;

  VehicleRun()
      : parameters(every_effect<Vehicle>()),
        plant(parameters, sample),
        reference(reference_of(parameters, plant)),
        system{&reference} {}
  VehicleRun(const VehicleRun&) = delete;
  VehicleRun& operator=(const VehicleRun&) = delete;

  PointOf<System> start() const {
    const ReferenceVehicle::Start given = start_of(plant.steady({}), Modes);
    PointOf<System> x = PointOf<System>::Zero();
    for (int e = 0; e < kEngines; ++e) {
      const auto& engine = given.engines[static_cast<std::size_t>(e)];
      const int first = e * System::kEngineStates;
      std::copy(engine.axes[0].begin(), engine.axes[0].end(), &x(first));
      std::copy(engine.axes[1].begin(), engine.axes[1].end(), &x(first + System::kAxisStates));
      std::copy(engine.bearing.begin(), engine.bearing.end(), &x(first + System::kBearing));
    }
    for (int k = 0; k < Modes; ++k) {
      x(System::kModes + 2 * k) = given.modes[static_cast<std::size_t>(k)];
    }
    return x;
  }
  std::size_t samples() const { return profile.size(); }
  void drive(std::size_t i) { std::copy(profile[i].commands.begin(), profile[i].commands.end(), system.commands.begin()); }
  static std::vector<double> read(const PointOf<System>& x) {
    std::vector<double> row;
    for (int axis = 0; axis < 2 * kEngines; ++axis) {
      const int first = axis / 2 * System::kEngineStates + axis % 2 * System::kAxisStates;
      row.insert(row.end(), {x(first + System::kPiston), x(first + System::kAngle)});
    }
    return row;
  }
  double error(const Rows& rows) const { return vehicle_error<Vehicle>(rows); }
  static std::vector<double> scales() {
    std::vector<double> scale;
    for (int e = 0; e < kEngines; ++e) {
      for (int axis = 0; axis < 2; ++axis) {
        scale.insert(scale.end(), {0.01, 1.0, 1e6, 1e6, 0.01, 0.1, 0.01, 0.1});
      }
      scale.insert(scale.end(), System::kEngineStates - System::kBearing, 1e-4);
    }
    for (int k = 0; k < Modes; ++k) {
      scale.insert(scale.end(), {0.1, 1.0});
    }
    return scale;
  }

  typename Vehicle::Parameters parameters;
  Vehicle plant;
  ReferenceVehicle reference;
  System system;
  Drive profile = command_profile<Vehicle>();
};

}  // namespace hotfire::test
