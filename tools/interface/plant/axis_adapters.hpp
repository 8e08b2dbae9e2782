// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/checks.hpp"
#include "model/key_text.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/interface/plant/plant.hpp"

namespace hotfire::plant {

// What `PlantOf` asks of a topology, in any scalar: its parameters, its model, its state, and what goes in and out.

inline constexpr double kLargest = std::numeric_limits<double>::max();

inline std::string_view meaning_of_channel(std::string_view channel) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kMeanings{
      {{"piston", "piston position as its sensor reads it"},
       {"engine", "engine angle as its sensor reads it"},
       {"load_pressure", "pressure across the piston as its sensor reads it"},
       {"position", "position as its sensor reads it"},
       {"velocity", "velocity as its sensor reads it"},
       {"acceleration", "acceleration as its sensor reads it"},
       {"motor_position", "angle of the motor as its sensor reads it"},
       {"motor_velocity", "speed of the motor as its sensor reads it"},
       {"current", "current of the motor as its sensor reads it"},
       {"force", "force that the motion takes, of the period before, as its sensor reads it"}}};
  const std::string_view kind = channel.substr(0, channel.find_last_not_of("23") + 1);
  const auto found = std::ranges::find(kMeanings, kind, [](const auto& meaning) { return meaning.first; });
  return found != kMeanings.end() ? found->second : std::string_view();
}

/// What both models have in common for `PlantOf`: their keys, channels and readings.
template <class S, class PlantModel>
struct ModelAdapter {
  using Model = PlantModel;
  using Parameters = typename Model::Parameters;
  struct State {
    typename Model::State plant{};
  };
  static constexpr std::size_t kOutputs = Model::channels.size();

  static std::vector<Variable> outputs(const Setup&) {
    std::vector<Variable> variables;
    for (std::size_t c = 0; c < kOutputs; ++c) {
      variables.push_back({std::string(Model::channels[c]), std::string(Model::channel_units[c]),
                           std::string(meaning_of_channel(Model::channels[c])), 0.0, -kLargest, kLargest});
    }
    return variables;
  }

  template <class Visitor, class AnyOf>
  static void visit(AnyOf& parameters, Visitor& visitor) {
    model::visit_keys(parameters, visitor);
  }

  static std::string_view broken(const Parameters& parameters) {
    const model::Broken part = model::broken_part(parameters);
    return part.relation.empty() ? model::broken_effect(parameters).relation : part.relation;
  }

  static const Parameters& of_model(const Parameters& parameters) { return parameters; }

  static State first_state(const Parameters&, const Setup&) { return {}; }

  static void smooth(Parameters&) {}
  static void begin_reading(State&, const Parameters&) noexcept {}

  static void read(State& state, double, std::span<S> outputs) noexcept {
    const auto& measured = Model::measured(state.plant);
    std::copy(measured.begin(), measured.end(), outputs.begin());
  }
};

/// What a torque on the engine [N m], held over a step, does to an axis, as `model::Simplex::step` asks for it.
template <class S>
auto under_torque(const model::Simplex<S>& model, const S& torque) {
  return [&model, &torque](const S&) {
    return model::Coupling<S>{S(0.0), model.parameters().actuator.moment_arm, S(-torque)};
  };
}

// The binary of an FMU is for any x86_64: these steps are compiled twice, and the processor that runs them chooses. Both
// versions give the same bits.

/// Advances an axis by one step with a command [rad] and a torque on its engine [N m], both held.
void step_axis(const model::Simplex<double>& model, model::Simplex<double>::State& state, const double& command,
               const double& torque) noexcept;

/// Advances a plant by one step with its input: a force or a setpoint that is held, or the position at the end of the step.
void advance(const model::Direct<double>& model, model::Direct<double>::State& state, const double& input) noexcept;
void advance(const model::Modal<double>& model, model::Modal<double>::State& state, const double& input) noexcept;
void advance(const model::Electromechanical<double>& model, model::Electromechanical<double>::State& state,
             const double& input) noexcept;
void advance(const model::ImposedMotion<double>& model, model::ImposedMotion<double>::State& state,
             const double& input) noexcept;

/// One hydraulic axis. Inputs: command [rad], torque on the engine [N m].
template <class S>
struct SimplexAdapter : ModelAdapter<S, model::Simplex<S>> {
  using typename ModelAdapter<S, model::Simplex<S>>::Model;
  using typename ModelAdapter<S, model::Simplex<S>>::Parameters;
  using typename ModelAdapter<S, model::Simplex<S>>::State;

  static int steps(const typename Model::Parameters&, double period) { return model::steps_per_period(period); }

  static std::vector<Variable> inputs(const Parameters&) {
    return {{"command", "rad", "commanded engine angle, held over a period", 0.0, -kLargest, kLargest},
            {"torque", "N.m", "torque on the engine towards positive angles, held over a period", 0.0, -kLargest, kLargest}};
  }

  static std::vector<Variable> further_parameters() { return {}; }

  static void settle(const Model& model, State& state, std::span<const S> inputs, const Parameters&, std::span<const S>,
                     double time) {
    state.plant = model.steady(inputs[0]);
    state.plant.clock = {model::Precise<S>(time)};
  }

  static void step(const Model& model, State& state, std::span<const S> inputs, const Parameters&) noexcept {
    if constexpr (std::same_as<S, double>) {
      step_axis(model, state.plant, inputs[0], inputs[1]);
    } else {
      // Dual numbers carry the slope by the torque, also where it is zero.
      model.step(state.plant, inputs[0], under_torque(model, inputs[1]));
    }
  }
};

/// What the topologies with one input have in common.
template <class S, class PlantModel>
struct OneInputAdapter : ModelAdapter<S, PlantModel> {
  using typename ModelAdapter<S, PlantModel>::Parameters;
  using typename ModelAdapter<S, PlantModel>::State;

  static int steps(const Parameters& parameters, double period) {
    return model::steps_per_period<PlantModel>(parameters, period);
  }

  static std::vector<Variable> further_parameters() { return {}; }

  static void step(const PlantModel& model, State& state, std::span<const S> inputs, const Parameters&) noexcept {
    if constexpr (std::same_as<S, double>) {
      advance(model, state.plant, inputs[0]);
    } else {
      model.step(state.plant, inputs[0]);
    }
  }

  /// Puts the plant into a state at a time [s].
  static void start_in(State& state, const typename PlantModel::State& plant, double time) {
    state.plant = plant;
    state.plant.clock = {model::Precise<S>(time)};
  }
};

/// A mass that a force drives. Input: force, in the record's own units.
template <class S>
struct DirectAdapter : OneInputAdapter<S, model::Direct<S>> {
  using Model = model::Direct<S>;
  using typename OneInputAdapter<S, model::Direct<S>>::Parameters;
  using typename OneInputAdapter<S, model::Direct<S>>::State;

  static std::vector<Variable> inputs(const Parameters&) {
    return {{"force", "", "force on the mass, held over a period", 0.0, -kLargest, kLargest}};
  }

  static std::vector<Variable> further_parameters() {
    return {{"start.position", "", "position at the start", 0.0, -kLargest, kLargest},
            {"start.velocity", "position/time", "velocity at the start", 0.0, -kLargest, kLargest}};
  }

  static void settle(const Model& model, State& state, std::span<const S>, const Parameters&, std::span<const S> further,
                     double time) {
    OneInputAdapter<S, Model>::start_in(state, model.moving(further[0], further[1]), time);
  }
};

/// A structure in modal coordinates. Input: force, in the record's own units.
template <class S>
struct ModalAdapter : OneInputAdapter<S, model::Modal<S>> {
  using Model = model::Modal<S>;
  using typename OneInputAdapter<S, model::Modal<S>>::Parameters;
  using typename OneInputAdapter<S, model::Modal<S>>::State;

  static std::vector<Variable> inputs(const Parameters&) {
    return {{"force", "", "force on the structure, held over a period", 0.0, -kLargest, kLargest}};
  }

  static void settle(const Model& model, State& state, std::span<const S>, const Parameters&, std::span<const S>,
                     double time) {
    OneInputAdapter<S, Model>::start_in(state, model.at_rest(S(0.0)), time);
  }
};

/// An electromechanical actuator. Input: setpoint, in the record's own units.
template <class S>
struct ElectromechanicalAdapter : OneInputAdapter<S, model::Electromechanical<S>> {
  using Model = model::Electromechanical<S>;
  using typename OneInputAdapter<S, model::Electromechanical<S>>::Parameters;
  using typename OneInputAdapter<S, model::Electromechanical<S>>::State;

  static std::vector<Variable> inputs(const Parameters&) {
    return {{"setpoint", "", "setpoint of the controller, held over a period", 0.0, -kLargest, kLargest}};
  }

  static void settle(const Model& model, State& state, std::span<const S> inputs, const Parameters&, std::span<const S>,
                     double time) {
    OneInputAdapter<S, Model>::start_in(state, model.steady(inputs[0]), time);
  }
};

/// A body that is moved along a path. Input: position at the end of a period, in the record's own units.
template <class S>
struct ImposedMotionAdapter : OneInputAdapter<S, model::ImposedMotion<S>> {
  using Model = model::ImposedMotion<S>;
  using typename OneInputAdapter<S, model::ImposedMotion<S>>::Parameters;
  using typename OneInputAdapter<S, model::ImposedMotion<S>>::State;

  static std::vector<Variable> inputs(const Parameters&) {
    return {{"position", "", "position of the body at the end of a period", 0.0, -kLargest, kLargest}};
  }

  static void settle(const Model& model, State& state, std::span<const S> inputs, const Parameters&, std::span<const S>,
                     double time) {
    OneInputAdapter<S, Model>::start_in(state, model.at_rest(inputs[0]), time);
  }
};

}  // namespace hotfire::plant
