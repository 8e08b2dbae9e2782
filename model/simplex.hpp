#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "model/effects.hpp"
#include "model/exact_hold.hpp"
#include "model/parts.hpp"
#include "model/root.hpp"

namespace hotfire::model {

/// One axis: the Simplex hydraulic servoactuator with mechanical feedback driving an engine on a gimbal, physics.md section
/// 1
/// ([SD] fig. 1b), with the effects of `List` at their sites.
///
/// Discretisation. The declared model without saturation, pressure drop and effects is linear: its state is advanced by the
/// exact hold, so that valve, oil and load are right at any step. All else (saturation, flow root, effects) enters as inputs
/// n, held over the step at their value for the mean of the step's two ends: y+ = transition y + response n(mean). Two
/// passes solve for the mean; velocities are mean velocities (displacement over the step), and stiff forces solve themselves
/// together with the velocity (`Motion`). Second order where the model is smooth, first order at stick and slip.
///
/// One step costs the same whatever the state: the passes are two, and no loop depends on data. No allocation, no lock, no
/// exception after construction. `State` is one flat block that the caller owns; copying it is a checkpoint.
template <class S, class List = SimplexEffects>
class Simplex {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view topology = "simplex";
  static constexpr std::string_view input_channel = "command";
  static constexpr std::array<std::string_view, 3> channels{"piston", "engine", "load_pressure"};
  static constexpr std::array<std::string_view, 3> channel_units{"m", "rad", "Pa"};
  static constexpr std::string_view input_unit = "rad";
  static constexpr int kPasses = 2;

  struct Parameters {
    Servovalve<S> servovalve;
    Actuator<S> actuator;
    Structure<S> structure;
    Engine<S> engine;
    EffectParameters<S, List> effects;

    /// Calls `f(part)` for every declared part.
    template <class Self, class F>
    static void for_each_part(Self& self, F&& f) {
      f(self.servovalve);
      f(self.actuator);
      f(self.structure);
      f(self.engine);
    }
  };

  /// Continuous states in the order of `Index`, then what the effects remember.
  struct State {
    Eigen::Matrix<S, 8, 1> y = Eigen::Matrix<S, 8, 1>::Zero();
    Eigen::Matrix<S, 6, 1> inputs = Eigen::Matrix<S, 6, 1>::Zero();
    S spring_force{0.0};
    EffectStates<S, List> effects{};
    std::array<S, 3> measured{};
  };

  enum Index { kOpening, kOpeningRate, kPressure, kWashout, kPiston, kPistonRate, kAngle, kAngleRate };

  /// Constants of a run at step `h` [s].
  Simplex(const Parameters& parameters, double h) : parameters_(parameters), h_(h) {
    const Servovalve<S>& valve = parameters_.servovalve;
    const Actuator<S>& actuator = parameters_.actuator;
    const Engine<S>& engine = parameters_.engine;
    stiffness_ = 1.0 / (1.0 / actuator.stiffness + 1.0 / parameters_.structure.stiffness);
    const S oil = 4.0 * actuator.bulk_modulus / actuator.trapped_volume;
    const S valve_squared = valve.natural_frequency * valve.natural_frequency;

    linear_ = Eigen::Matrix<S, 8, 8>::Zero();
    linear_(kOpening, kOpeningRate) = S{1.0};
    linear_(kOpeningRate, kOpening) = -valve_squared;
    linear_(kOpeningRate, kOpeningRate) = -2.0 * valve.damping_ratio * valve.natural_frequency;
    linear_(kOpeningRate, kPiston) = -valve_squared * valve.position_gain;
    linear_(kOpeningRate, kPressure) = -valve_squared * valve.pressure_feedback_gain;
    linear_(kOpeningRate, kWashout) = valve_squared * valve.pressure_feedback_gain;
    linear_(kPressure, kOpening) = oil * valve.rated_flow;
    linear_(kPressure, kPistonRate) = -oil * actuator.piston_area;
    linear_(kPressure, kPressure) = -oil * actuator.leakage;
    linear_(kWashout, kPressure) = valve.pressure_feedback_corner;
    linear_(kWashout, kWashout) = -valve.pressure_feedback_corner;
    linear_(kPiston, kPistonRate) = S{1.0};
    linear_(kPistonRate, kPressure) = actuator.piston_area / actuator.piston_mass;
    linear_(kPistonRate, kPistonRate) = -actuator.piston_damping / actuator.piston_mass;
    linear_(kPistonRate, kPiston) = -stiffness_ / actuator.piston_mass;
    linear_(kPistonRate, kAngle) = stiffness_ * actuator.moment_arm / actuator.piston_mass;
    linear_(kAngle, kAngleRate) = S{1.0};
    linear_(kAngleRate, kPiston) = stiffness_ * actuator.moment_arm / engine.inertia;
    linear_(kAngleRate, kAngle) =
        -(engine.duct_stiffness + stiffness_ * actuator.moment_arm * actuator.moment_arm) / engine.inertia;
    linear_(kAngleRate, kAngleRate) = -engine.viscous_damping / engine.inertia;

    driven_ = Eigen::Matrix<S, 8, 6>::Zero();
    driven_(kOpeningRate, kCommand) = valve_squared * valve.position_gain;
    driven_(kOpeningRate, kValveCommand) = valve_squared;
    driven_(kPressure, kFlow) = oil;
    driven_(kPistonRate, kPistonForce) = -1.0 / actuator.piston_mass;
    driven_(kPistonRate, kSpringForce) = -1.0 / actuator.piston_mass;
    driven_(kAngleRate, kSpringForce) = actuator.moment_arm / engine.inertia;
    driven_(kAngleRate, kEngineTorque) = -1.0 / engine.inertia;

    hold_ = exact_hold<S, 8, 6>(linear_, driven_, h);
    piston_compliance_ = -hold_.response(kPiston, kPistonForce) / h;
    engine_compliance_ = -hold_.response(kAngle, kEngineTorque) / h;
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// The steady state under a constant command [rad]: set-up only. The piston stands where the valve's flow makes up for the
  /// leakage, the engine where its torques balance; friction starts unloaded. Where a dead band leaves the piston free, it
  /// stands at the command.
  State steady(const S& command) const {
    State state;
    settle<Site::command>(parameters_.effects, state.effects, Signal<S>{command, h_});
    state.inputs(kCommand) = parameters_.actuator.moment_arm * command;
    constexpr double kWidth = 1e-6;  // m, rad: far below what a sensor sees
    const auto flow_at = [&](const S& piston) {
      state.y(kPiston) = piston;
      const auto force_at = [&](const S& angle) { return excess_force(state, angle); };
      state.y(kAngle) = root_of_decreasing<S>(piston / parameters_.actuator.moment_arm, kWidth, force_at);
      excess_force(state, state.y(kAngle));
      return net_flow(state);
    };
    flow_at(root_of_decreasing<S>(state.inputs(kCommand), kWidth, flow_at));
    evaluate(state, state.y, state.y, Keep::no);
    const std::array<S, 3> truth{state.y(kPiston), state.y(kAngle), state.y(kPressure)};
    for (std::size_t channel = 0; channel < truth.size(); ++channel) {
      settle_channel<S, List>(static_cast<int>(channel), parameters_.effects, state.effects, Signal<S>{truth[channel], h_});
    }
    measure(state);
    return state;
  }

  /// Advances by one step with the command [rad] held.
  void step(State& state, const S& command) const noexcept {
    const Signal<S> angle =
        pass_through<Site::command>(parameters_.effects, state.effects, Signal<S>{command, h_}, Keep::yes);
    state.inputs(kCommand) = parameters_.actuator.moment_arm * angle.value;
    const Eigen::Matrix<S, 8, 1> start = state.y;
    const Eigen::Matrix<S, 8, 1> free = times(hold_.transition, start);
    for (int pass = 0; pass < kPasses; ++pass) {
      const Eigen::Matrix<S, 8, 1> end = free + times(hold_.response, state.inputs);
      evaluate(state, start, end, pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    state.y = free + times(hold_.response, state.inputs);
    measure(state);
  }

  /// What the sensors read, in the order of `channels`.
  static const std::array<S, 3>& measured(const State& state) noexcept { return state.measured; }

 private:
  enum Input { kCommand, kValveCommand, kFlow, kPistonForce, kSpringForce, kEngineTorque };

  /// Fills `state.inputs` (all but the command) for a step that goes from `start` to `end`.
  void evaluate(State& state, const Eigen::Matrix<S, 8, 1>& start, const Eigen::Matrix<S, 8, 1>& end,
                Keep keep) const noexcept {
    const Servovalve<S>& valve = parameters_.servovalve;
    const Actuator<S>& actuator = parameters_.actuator;
    const Eigen::Matrix<S, 8, 1> mean = S(0.5) * (start + end);
    const auto& effects = parameters_.effects;

    const S linear_command = valve.position_gain * (state.inputs(kCommand) - mean(kPiston)) -
                             valve.pressure_feedback_gain * (mean(kPressure) - mean(kWashout));
    const S saturated = clamp_symmetric<S>(linear_command, S{1.0});
    state.inputs(kValveCommand) =
        pass_through<Site::valve_command>(effects, state.effects, Signal<S>{saturated, h_}, keep).value - linear_command;

    const S opening = pass_through<Site::valve>(effects, state.effects, Signal<S>{mean(kOpening), h_}, keep).value;
    const S drop = 1.0 - sign_of(opening) * mean(kPressure) / actuator.supply_pressure;
    // The root's slope is infinite at zero drop; below 1e-9 of the supply the flow is zero to any sensor.
    const S flow = valve.rated_flow * opening * sqrt(value_of(drop) > 1e-9 ? drop : S{1e-9});
    state.inputs(kFlow) = flow - valve.rated_flow * mean(kOpening) +
                          sum_over<Site::flow>(effects, state.effects,
                                               Hydraulics<S>{mean(kPressure), opening, actuator.supply_pressure, h_}, keep);

    const S piston_rate = (end(kPiston) - start(kPiston)) / h_;
    state.inputs(kPistonForce) = sum_over<Site::piston>(
        effects, state.effects, Motion<S>{mean(kPiston), piston_rate, piston_rate, piston_compliance_, h_}, keep);

    const S attach_motion = sum_over<Site::structure>(effects, state.effects, AttachPoint<S>{state.spring_force, h_}, keep);
    const S linear_deflection = mean(kPiston) - actuator.moment_arm * mean(kAngle);
    const Spring<S> spring = pass_through<Site::load_spring>(
        effects, state.effects,
        Spring<S>{linear_deflection - attach_motion, mean(kAngle), actuator.moment_arm, actuator.moment_arm, stiffness_,
                  actuator.stiffness, parameters_.structure.stiffness, h_},
        keep);
    state.spring_force = stiffness_ * spring.deflection;
    state.inputs(kSpringForce) = state.spring_force - stiffness_ * linear_deflection;

    const S angle_rate = (end(kAngle) - start(kAngle)) / h_;
    state.inputs(kEngineTorque) =
        sum_over<Site::engine_torque>(effects, state.effects,
                                      Motion<S>{mean(kAngle), angle_rate, angle_rate, engine_compliance_, h_}, keep) -
        (spring.arm - actuator.moment_arm) * state.spring_force;
  }

  /// At rest at `angle`, with the piston where `state` has it: the force of the load spring beyond what the engine's torques
  /// need [N]. Leaves angle, force and the structure's deflection in `state`.
  S excess_force(State& state, const S& angle) const noexcept {
    const auto& effects = parameters_.effects;
    const S nominal = parameters_.actuator.moment_arm;
    state.y(kAngle) = angle;
    // Keeps what the springs remember of their force, so that the search in them starts near it.
    const Spring<S> geometry =
        pass_through<Site::load_spring>(effects, state.effects,
                                        Spring<S>{state.y(kPiston) - nominal * angle, angle, nominal, nominal, stiffness_,
                                                  parameters_.actuator.stiffness, parameters_.structure.stiffness, h_},
                                        Keep::yes);
    const S torque = sum_over<Site::engine_torque>(effects, state.effects,
                                                   Motion<S>{angle, S{0.0}, S{0.0}, engine_compliance_, h_}, Keep::no);
    const S needed = (parameters_.engine.duct_stiffness * angle + torque) / geometry.arm;
    state.spring_force = needed;
    settle<Site::structure>(effects, state.effects, AttachPoint<S>{needed, h_});
    evaluate(state, state.y, state.y, Keep::no);
    return state.spring_force - needed;
  }

  /// At rest under the load in `state`: what flows into the extend chamber [m^3/s]. Leaves pressure and spool in `state`.
  S net_flow(State& state) const noexcept {
    const Servovalve<S>& valve = parameters_.servovalve;
    state.y(kPressure) = state.spring_force / parameters_.actuator.piston_area;
    state.y(kWashout) = state.y(kPressure);
    evaluate(state, state.y, state.y, Keep::no);
    state.y(kOpening) = valve.position_gain * (state.inputs(kCommand) - state.y(kPiston)) + state.inputs(kValveCommand);
    evaluate(state, state.y, state.y, Keep::no);
    return valve.rated_flow * state.y(kOpening) + state.inputs(kFlow) - parameters_.actuator.leakage * state.y(kPressure);
  }

  void measure(State& state) const noexcept {
    const std::array<S, 3> truth{state.y(kPiston), state.y(kAngle), state.y(kPressure)};
    for (std::size_t channel = 0; channel < truth.size(); ++channel) {
      state.measured[channel] =
          pass_through_sensor<S, List>(static_cast<int>(channel), parameters_.effects, state.effects, truth[channel], h_);
    }
  }

  Parameters parameters_;
  double h_;
  S stiffness_{0.0};
  Eigen::Matrix<S, 8, 8> linear_;
  Eigen::Matrix<S, 8, 6> driven_;
  ExactHold<S, 8, 6> hold_;
  S piston_compliance_{0.0};
  S engine_compliance_{0.0};
};

}  // namespace hotfire::model
