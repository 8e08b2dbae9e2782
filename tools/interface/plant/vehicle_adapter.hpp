// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/sensors/vehicle_sensors.hpp"
#include "model/vehicle.hpp"
#include "model/vehicle_keys.hpp"
#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/normal.hpp"
#include "tools/interface/plant/plant.hpp"

namespace hotfire::plant {

/// A vehicle with what reads it. Inputs and outputs have the names of a record's channels ("command.pitch", of several
/// engines "command.pitch1"): of every axis command, torque and vibration, of every engine force and thrust.
template <class V>
struct VehicleAdapter {
  using S = typename V::Scalar;
  using Model = V;
  using Parameters = model::InstrumentedVehicle<V>;
  using Sensors = model::VehicleSensors<V>;
  static constexpr std::size_t kAxes = V::kAxes;
  static constexpr std::size_t kEngines = V::kEngines;
  static constexpr std::size_t kStrings = Sensors::kStrings;
  static constexpr std::size_t kCoordinates = 3;
  // Where the inputs of each kind begin.
  static constexpr std::size_t kTorque = kAxes;
  static constexpr std::size_t kVibration = 2 * kAxes;
  static constexpr std::size_t kForce = 3 * kAxes;
  static constexpr std::size_t kThrust = kForce + kCoordinates * kEngines;

  struct State {
    State(const Sensors& sensors, const Setup& setup)
        : readings(sensors, plant), strings(setup.strings), normal(setup.seed) {
      // As many numbers as `hotfire simulate` takes to place the strings, three for each.
      for (std::size_t i = 0; strings && i < kCoordinates * kStrings; ++i) {
        normal();
      }
    }

    typename V::State plant{};
    model::VehicleReadings<V> readings;
    bool strings;
    Normal normal;
  };

  static int steps(const typename Model::Parameters&, double period) { return model::steps_per_period(period); }

  static std::vector<Variable> inputs(const Parameters& parameters) {
    std::vector<Variable> variables;
    const auto add = [&](std::string name, const char* unit, const char* meaning, double start, double lower) {
      variables.push_back({std::move(name), unit, meaning, start, lower, kLargest});
    };
    for (std::size_t i = 0; i < kAxes; ++i) {
      add("command." + axis_name(i), "rad", "commanded engine angle, held over a period", 0.0, -kLargest);
    }
    for (std::size_t i = 0; i < kAxes; ++i) {
      add("torque." + axis_name(i), "N.m", "torque on the engine towards positive angles, held over a period", 0.0,
          -kLargest);
    }
    for (std::size_t i = 0; i < kAxes; ++i) {
      add("vibration." + axis_name(i), "rad/s", "vibration of the bearing as slip velocity, held over a period", 0.0,
          -kLargest);
      // A law that has the vibration already and a recorded one would be the same physics twice.
      if (parameters.vehicle.gimbals[i / 2].friction.law() == model::BearingFriction<S>::Law::vibrated_lugre) {
        variables.back().lower = 0.0;
        variables.back().upper = 0.0;
      }
    }
    for (std::size_t e = 0; e < kEngines; ++e) {
      for (const char* direction : {"x", "y", "z"}) {
        add(std::string("force.") + direction + engine_number(e), "N",
            "force on the engine at its gimbal's centre, held over a period", 0.0, -kLargest);
      }
    }
    for (std::size_t e = 0; e < kEngines; ++e) {
      add(kEngines == 1 ? std::string("thrust") : "thrust.engine" + engine_number(e), "N",
          "thrust of the engine, held over a period", model::value_of(parameters.vehicle.gimbals[e].bearing.thrust), 0.0);
    }
    return variables;
  }

  static std::vector<Variable> outputs(const Setup& setup) {
    std::vector<Variable> variables;
    for (std::size_t i = 0; i < kAxes; ++i) {
      for (std::size_t c = 0; c < V::kChannels; ++c) {
        const std::string_view channel = V::AxisModel::channels[c];
        variables.push_back({std::string(channel) + "." + axis_name(i), std::string(V::AxisModel::channel_units[c]),
                             std::string(meaning_of_channel(channel)), 0.0, -kLargest, kLargest});
      }
    }
    for (std::size_t k = 0; setup.strings && k < kStrings; ++k) {
      const std::size_t each = kStrings / kEngines;
      const std::string name = "string" + std::to_string(k % each + 1);
      variables.push_back({kEngines == 1 ? name : name + ".engine" + engine_number(k / each), "m",
                           "change of the string's length from zero angles as its sensor reads it", 0.0, -kLargest,
                           kLargest});
    }
    return variables;
  }

  static std::vector<Variable> further_parameters() { return {}; }

  template <class Visitor, class AnyOf>
  static void visit(AnyOf& parameters, Visitor& visitor) {
    model::visit_vehicle_keys(parameters, visitor);
  }

  static std::string_view broken(const Parameters& parameters) {
    const auto& vehicle = parameters.vehicle;
    std::string_view broken;
    const auto note = [&broken](std::string_view what) { broken = broken.empty() ? what : broken; };
    for (std::size_t e = 0; e < kEngines; ++e) {
      note(model::broken_effect(vehicle.axes[2 * e]).relation);
      note(model::broken_effect(vehicle.axes[2 * e + 1]).relation);
      if (!vehicle.constant_arms[e]) {
        note(model::broken_relation(vehicle.attach[2 * e], vehicle.attach[2 * e + 1]));
      }
      note(model::broken_relation(vehicle.gimbals[e]));
      note(model::StringPotentiometers<S>::broken_relation(parameters.sensors.anchors[e]));
    }
    return broken;
  }

  static const typename V::Parameters& of_model(const Parameters& parameters) { return parameters.vehicle; }

  static State first_state(const Parameters& parameters, const Setup& setup) { return State(parameters.sensors, setup); }

  static void settle(const Model& model, State& state, std::span<const S> inputs, const Parameters& parameters,
                     std::span<const S>, double time) {
    const typename V::Inputs driven = inputs_of(inputs, parameters);
    state.plant = model.steady(driven.commands, driven.thrust);
    for (auto& axis : state.plant.axes) {
      axis.clock = {model::Precise<S>(time)};
    }
  }

  static void step(const Model& model, State& state, std::span<const S> inputs, const Parameters& parameters) noexcept {
    model.step(state.plant, inputs_of(inputs, parameters));
  }

  /// Readings without noise and steps, which have no slope.
  static void smooth(Parameters& parameters) {
    for (auto* readout : {&parameters.sensors.piston, &parameters.sensors.string}) {
      readout->noise = S(0.0);
      readout->step = S(0.0);
    }
  }

  /// Readings at rest in the present state. What a reading remembers adds to it, so that slopes do not depend on it.
  static void begin_reading(State& state, const Parameters& parameters) noexcept {
    state.readings = model::VehicleReadings<V>(parameters.sensors, state.plant);
  }

  /// A number of the noise of readings; dual numbers have none.
  static S drawn([[maybe_unused]] State& state) noexcept {
    if constexpr (std::same_as<S, double>) {
      return state.normal();
    } else {
      return S(0.0);
    }
  }

  static void read(State& state, double period, std::span<S> outputs) noexcept {
    const auto draw = [&] { return drawn(state); };
    state.readings.read_pistons(state.plant, period, draw);
    const auto& measured = V::measured(state.plant);
    for (std::size_t r = 0; r < measured.size(); ++r) {
      outputs[r] = r % V::kChannels == 0 ? state.readings.pistons()[r / V::kChannels] : measured[r];
    }
    if (state.strings) {
      state.readings.read_strings(state.plant, period, draw);
      for (std::size_t k = 0; k < kStrings; ++k) {
        outputs[measured.size() + k] = state.readings.strings()[k];
      }
    }
  }

 private:
  static std::string engine_number(std::size_t engine) { return kEngines == 1 ? std::string{} : std::to_string(engine + 1); }
  static std::string axis_name(std::size_t axis) { return (axis % 2 == 0 ? "pitch" : "yaw") + engine_number(axis / 2); }

  static typename V::Inputs inputs_of(std::span<const S> inputs, const Parameters& parameters) noexcept {
    typename V::Inputs driven;
    for (std::size_t i = 0; i < kAxes; ++i) {
      driven.commands[i] = inputs[i];
      driven.torque[i] = inputs[kTorque + i];
      driven.vibration[i] = inputs[kVibration + i];
    }
    for (std::size_t e = 0; e < kEngines; ++e) {
      for (std::size_t c = 0; c < kCoordinates; ++c) {
        driven.force[e](static_cast<Eigen::Index>(c)) = inputs[kForce + kCoordinates * e + c];
      }
      driven.thrust[e] = inputs[kThrust + e] - parameters.vehicle.gimbals[e].bearing.thrust;
    }
    return driven;
  }
};

}  // namespace hotfire::plant
