// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/interface/plant/axis_adapters.hpp"
#include "tools/interface/plant/vehicle_adapter.hpp"
#include "tools/linear/plant/ports.hpp"

namespace hotfire::linear {

// What `PlantOf` asks of a topology with ports, in any scalar, beside what the adapters of tools/interface/plant/ say of it.

/// One axis.
template <class S>
struct SimplexTopology {
  using Scalar = S;
  using Model = PortedSimplex<S>;
  using Axis = Model;
  using Parameters = typename Model::Parameters;
  using Adapter = plant::SimplexAdapter<S>;
  static constexpr int kAxes = 1;
  static constexpr bool is_vehicle = false;

  struct State {
    State(const Parameters&, const typename Model::State& start) : plant(start) {}
    typename Model::State plant;
  };

  template <class Visitor, class AnyOf>
  static void visit(AnyOf& parameters, Visitor& visitor) {
    model::visit_keys(parameters, visitor);
  }
  static const Parameters& of_model(const Parameters& parameters) { return parameters; }
  static auto& axis(Parameters& parameters, std::size_t) { return parameters; }
  static const auto& axis(const Parameters& parameters, std::size_t) { return parameters; }
  static const Axis& axis(const Model& model, int) { return model; }
  static auto& axis(State& state, std::size_t) { return state.plant; }
  static std::string suffix(std::size_t) { return {}; }
  static std::vector<plant::Variable> inputs(const Parameters&) { return Adapter::inputs({}); }

  static double longest_step(const Parameters& parameters) { return Model::longest_step(parameters); }

  static typename Model::State steady(const Model& model, std::span<const double> commands) {
    return model.steady(S(commands[0]));
  }

  static void step(const Model& model, State& state, std::span<const S> inputs, const Parameters&) noexcept {
    const S& arm = model.parameters().actuator.moment_arm;
    model.step(state.plant, inputs[0], [&](const S&) { return model::Coupling<S>{S(0.0), arm, S(-inputs[1])}; });
  }

  static void read(State& state, double, const Parameters&, std::span<S> outputs) noexcept {
    const auto& measured = Model::measured(state.plant);
    std::copy(measured.begin(), measured.end(), outputs.begin());
  }
};

/// A vehicle, whose pistons are read through their potentiometers.
template <class V>
struct VehicleTopology {
  using S = typename V::Scalar;
  using Scalar = S;
  using Model = V;
  using Axis = typename V::AxisModel;
  using Parameters = model::InstrumentedVehicle<V>;
  using Adapter = plant::VehicleAdapter<V>;
  static constexpr int kAxes = V::kAxes;
  static constexpr bool is_vehicle = true;

  struct State {
    State(const Parameters& parameters, const typename V::State& start)
        : own(parameters.sensors, plant::Setup{}), plant(own.plant) {
      plant = start;
      for (std::size_t i = 0; i < piston_lag.size(); ++i) {
        model::PotentiometerReadout<S>::settle(piston_lag[i], V::measured(plant)[i * V::kChannels]);
      }
    }
    State(const State& other) : own(other.own), plant(own.plant), piston_lag(other.piston_lag) {}
    State& operator=(const State&) = delete;

    typename Adapter::State own;
    typename V::State& plant;  ///< within `own`
    std::array<model::SensorLag::State<S>, static_cast<std::size_t>(V::kAxes)> piston_lag{};
  };

  template <class Visitor, class AnyOf>
  static void visit(AnyOf& parameters, Visitor& visitor) {
    model::visit_vehicle_keys(parameters, visitor);
  }
  static const typename V::Parameters& of_model(const Parameters& parameters) { return parameters.vehicle; }
  static auto& axis(Parameters& parameters, std::size_t i) { return parameters.vehicle.axes[i]; }
  static const auto& axis(const Parameters& parameters, std::size_t i) { return parameters.vehicle.axes[i]; }
  static Axis axis(const Model& model, int i) { return model.axis(i); }
  static auto& axis(State& state, std::size_t i) { return state.plant.axes[i]; }
  static std::string suffix(std::size_t i) {
    return std::string(i % 2 == 0 ? ".pitch" : ".yaw") + (V::kEngines == 1 ? std::string{} : std::to_string(i / 2 + 1));
  }

  static std::vector<plant::Variable> inputs(const Parameters& parameters) { return Adapter::inputs(parameters); }

  static double longest_step(const Parameters&) { return model::kLongestStep; }

  static typename V::State steady(const Model& model, std::span<const double> commands) {
    std::array<S, static_cast<std::size_t>(V::kAxes)> given{};
    std::copy(commands.begin(), commands.end(), given.begin());
    return model.steady(given);
  }

  static void step(const Model& model, State& state, std::span<const S> inputs, const Parameters& parameters) noexcept {
    Adapter::step(model, state.own, inputs, parameters);
  }

  static void read(State& state, double h, const Parameters& parameters, std::span<S> outputs) noexcept {
    const auto& measured = V::measured(state.plant);
    for (std::size_t r = 0; r < measured.size(); ++r) {
      outputs[r] = r % V::kChannels == 0
                       ? parameters.sensors.piston.read(state.piston_lag[r / V::kChannels], measured[r], S(0.0), h)
                       : measured[r];
    }
  }
};

template <class S>
using TaosTopology = VehicleTopology<PortedTaos<S>>;
template <class S>
using MasvTopology = VehicleTopology<PortedMasv<S>>;

}  // namespace hotfire::linear
