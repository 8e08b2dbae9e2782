// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "model/actuator/parts.hpp"
#include "model/actuator/surroundings.hpp"
#include "model/declaration/effect.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/exact_hold.hpp"

namespace hotfire::model {

/// Inputs of an axis of a `Vehicle` from the other axes and the structure, as means over one step.
template <class S>
struct Coupling {
  S motion;            ///< motion of the attach point, and stroke of the geometry beyond R beta [m]
  S arm;               ///< derivative of the stroke by the axis's own angle [m]
  S torque;            ///< further torque against the engine [N m]; read by `evaluate_engine` only, like the two below
  S other_angle{0.0};  ///< of the engine about its other axis [rad]
  S other_rate{0.0};   ///< its rate [rad/s]
};

/// An axis alone: its attach point is on its own spring and its arm is the declared one.
struct Uncoupled {};

/// One axis: the hydraulic servoactuator with mechanical feedback driving an engine on a gimbal, physics.md section 1
/// ([SD] fig. 1b), with the effects of `List` at their sites. `Simplex` is one alone, `Vehicle` several on a structure.
///
/// Discretisation. The declared model without saturation, pressure drop and effects is linear: its state is advanced by the
/// exact hold, so that valve, oil and load are right at any step. All else (saturation, flow root, effects) enters as inputs
/// n, held over the step at their value for the mean of the step's two ends: y+ = transition y + response n(mean). Two
/// passes solve for the mean; velocities are mean velocities (displacement over the step), and stiff forces solve themselves
/// together with the velocity (`Motion`). Second order where the model is smooth, first order at stick and slip.
///
/// One step costs the same whatever the state, without allocation, lock or exception. A copy of `State` is a checkpoint.
template <class S, class List>
class Axis : public AxisStates {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view input_channel = "command";
  static constexpr std::array<std::string_view, 3> channels{"piston", "engine", "load_pressure"};
  static constexpr std::array<std::string_view, 3> channel_units{"m", "rad", "Pa"};
  static constexpr std::string_view input_unit = "rad";

  struct Parameters {
    Servovalve<S> servovalve;
    Actuator<S> actuator;
    Structure<S> structure;
    Engine<S> engine;
    EffectParameters<S, List> effects;

    /// Calls `f(part)` for every declared part.
    template <class Self, class F>
    static constexpr void for_each_part(Self& self, F&& f) {
      f(self.servovalve);
      f(self.actuator);
      f(self.structure);
      f(self.engine);
    }
  };

  /// Continuous states in the order of `Index`, then the memories of the effects.
  struct State {
    Eigen::Matrix<S, 8, 1> y = Eigen::Matrix<S, 8, 1>::Zero();
    Eigen::Matrix<S, 6, 1> inputs = Eigen::Matrix<S, 6, 1>::Zero();
    S spring_force{0.0};
    S built_up{0.0};   ///< of the flow input, what the effects of the oil add [m^3/s]
    Clock<S> clock{};  ///< time of the record, for effects that depend on it
    EffectStates<S, List> effects{};
    std::array<S, 3> measured{};
  };

  /// Inputs that are held over a step: piston command [m], valve command [-], flow into the extend chamber [m^3/s], force
  /// against the piston and of the load spring [N], torque against the engine [N m].
  enum Input { kCommand, kValveCommand, kFlow, kPistonForce, kSpringForce, kEngineTorque };

  /// A step that is not complete: its start, its end without inputs, and its end with the inputs that are known so far.
  struct Advance {
    Eigen::Matrix<S, 8, 1> start;
    Eigen::Matrix<S, 8, 1> free;
    Eigen::Matrix<S, 8, 1> end;
    Eigen::Matrix<S, 8, 1> middle;  ///< mean of start and end
    S built_up{0.0};                ///< flow of the oil's effects among those inputs [m^3/s]
    Precise<S> time{0.0};           ///< of the record, mean over the step [s]

    /// Mean over the step, and mean rate: displacement over the step.
    const S& mean(int index) const noexcept { return middle(index); }
    S rate(int index, double h) const noexcept { return (end(index) - start(index)) / h; }
  };

  /// Constants of a run at step `h` [s].
  Axis(const Parameters& parameters, double h) : parameters_(parameters), acting_(parameters.effects.active), h_(h) {
    const Servovalve<S>& valve = parameters_.servovalve;
    const Actuator<S>& actuator = parameters_.actuator;
    const Engine<S>& engine = parameters_.engine;
    stiffness_ = 1.0 / (1.0 / actuator.stiffness + 1.0 / parameters_.structure.stiffness);
    const S oil = 4.0 * actuator.bulk_modulus / actuator.trapped_volume;
    const S valve_squared = valve.natural_frequency * valve.natural_frequency;

    Eigen::Matrix<S, 8, 8> linear = Eigen::Matrix<S, 8, 8>::Zero();
    linear(kOpening, kOpeningRate) = S{1.0};
    linear(kOpeningRate, kOpening) = -valve_squared;
    linear(kOpeningRate, kOpeningRate) = -2.0 * valve.damping_ratio * valve.natural_frequency;
    linear(kOpeningRate, kPiston) = -valve_squared * valve.position_gain * valve.position_feedback;
    linear(kOpeningRate, kPressure) = -valve_squared * valve.pressure_feedback_gain;
    linear(kOpeningRate, kWashout) = valve_squared * valve.pressure_feedback_gain;
    linear(kPressure, kOpening) = oil * valve.rated_flow;
    linear(kPressure, kPistonRate) = -oil * actuator.piston_area;
    linear(kPressure, kPressure) = -oil * actuator.leakage;
    linear(kWashout, kPressure) = valve.pressure_feedback_corner;
    linear(kWashout, kWashout) = -valve.pressure_feedback_corner;
    linear(kPiston, kPistonRate) = S{1.0};
    linear(kPistonRate, kPressure) = actuator.piston_area / actuator.piston_mass;
    linear(kPistonRate, kPistonRate) = -actuator.piston_damping / actuator.piston_mass;
    linear(kPistonRate, kPiston) = -stiffness_ / actuator.piston_mass;
    linear(kPistonRate, kAngle) = stiffness_ * actuator.moment_arm / actuator.piston_mass;
    linear(kAngle, kAngleRate) = S{1.0};
    linear(kAngleRate, kPiston) = stiffness_ * actuator.moment_arm / engine.inertia;
    linear(kAngleRate, kAngle) =
        -(engine.duct_stiffness + stiffness_ * actuator.moment_arm * actuator.moment_arm) / engine.inertia;
    linear(kAngleRate, kAngleRate) = -engine.viscous_damping / engine.inertia;

    Eigen::Matrix<S, 8, 6> driven = Eigen::Matrix<S, 8, 6>::Zero();
    driven(kOpeningRate, kCommand) = valve_squared * valve.position_gain;
    driven(kOpeningRate, kValveCommand) = valve_squared;
    driven(kPressure, kFlow) = oil;
    driven(kPistonRate, kPistonForce) = -1.0 / actuator.piston_mass;
    driven(kPistonRate, kSpringForce) = -1.0 / actuator.piston_mass;
    driven(kAngleRate, kSpringForce) = actuator.moment_arm / engine.inertia;
    driven(kAngleRate, kEngineTorque) = -1.0 / engine.inertia;

    hold_ = exact_hold<S, 8, 6>(linear, driven, h);
    piston_compliance_ = -hold_.response(kPiston, kPistonForce) / h;
    engine_compliance_ = -hold_.response(kAngle, kEngineTorque) / h;
    const S relief = actuator.piston_area * hold_.response(kPiston, kFlow) / h +
                     0.5 * actuator.leakage * hold_.response(kPressure, kFlow) -
                     0.5 * valve.rated_flow * hold_.response(kOpening, kFlow);
    flow_relief_ = select(relief < kMostRelief, relief, S{kMostRelief});
  }

  const Parameters& parameters() const& noexcept { return parameters_; }
  Parameters parameters() const&& { return parameters_; }  ///< by value: the axis is a temporary
  double step_size() const noexcept { return h_; }

  S stiffness() const noexcept { return stiffness_; }  ///< K_T of the declared load spring [N/m]

  /// Change of the continuous states by a unit of every input, held over a step: a column for each of `Input`.
  Eigen::Matrix<S, 8, 6> input_response() const noexcept { return hold_.response; }

  /// Change of the engine's rate over a step by a unit of mean torque against it [rad/s/(N m)].
  S engine_compliance() const noexcept { return engine_compliance_; }

  /// The steady state under a constant command [rad]: set-up only. The valve's flow equals the leakage, the engine's torques
  /// balance, friction is unloaded. If a dead band leaves the piston free, it is at the command. `piston` is where the
  /// piston was seen [m]: without position feedback it is held there until the first step (at 0 if it was not seen), and a
  /// play in the valve lets it rest there, as far as the play goes.
  template <class Around>
  State settled(const S& command, const Around& around, const std::optional<double>& piston = std::nullopt) const;

  /// Opens a step with the command [rad] held.
  void begin(State& state, const S& command, Advance& advance) const noexcept {
    advance.time = mid_step(state);
    const Surroundings<S> seen = around_state(state, state.y, advance.time);
    Signal<S> angle{command, h_, advance.time, S{0.0}, &seen};
    pass_through<Site::command>(parameters_.effects, acting_, state.effects, angle, Keep::yes);
    state.inputs(kCommand) = parameters_.actuator.moment_arm * angle.value;
    advance.start = state.y;
    advance.free = times(hold_.transition, state.y);
  }

  /// The end of the step with the inputs that are known so far.
  void predict(const State& state, Advance& advance) const noexcept {
    advance.end = advance.free + times(hold_.response, state.inputs);
    advance.middle = S(0.5) * (advance.start + advance.end);
    advance.built_up = state.built_up;
  }

  /// Valve, oil, piston and load spring over a predicted step: fills their inputs and the spring's force.
  template <class Around>
  Spring<S> evaluate_actuator(State& state, const Advance& advance, const Around& around, Keep keep) const noexcept {
    const Servovalve<S>& valve = parameters_.servovalve;
    const Actuator<S>& actuator = parameters_.actuator;
    const Eigen::Matrix<S, 8, 1>& mean = advance.middle;
    const auto& effects = parameters_.effects;
    const Precise<S>& time = advance.time;
    const Surroundings<S> seen = around_state(state, mean, time);

    const S linear_command = torque_motor(state, mean);
    Signal<S> valve_command{saturated(linear_command), h_, time, S{0.0}, &seen};
    if (acting_.template any<Site::valve_command>()) {
      valve_command.change = saturated(torque_motor(state, advance.end)) - saturated(torque_motor(state, advance.start));
    }
    pass_through<Site::valve_command>(effects, acting_, state.effects, valve_command, keep);
    state.inputs(kValveCommand) = valve_command.value - linear_command;

    Hydraulics<S> oil = hydraulics(state, mean(kOpening), mean(kPressure), seen, keep);
    state.inputs(kFlow) =
        oil.flow - valve.rated_flow * mean(kOpening) + sum_over<Site::flow>(effects, acting_, state.effects, oil, keep);

    const S piston_rate = advance.rate(kPiston, h_);
    const S net_flow = valve.rated_flow * mean(kOpening) + state.inputs(kFlow) - actuator.piston_area * piston_rate -
                       actuator.leakage * mean(kPressure);
    Compression<S> oil_compression{net_flow + flow_relief_ * advance.built_up, flow_relief_, mean(kPressure), h_};
    state.built_up = sum_over<Site::pressure>(effects, acting_, state.effects, oil_compression, keep);
    state.inputs(kFlow) += state.built_up;
    Motion<S> motion{mean(kPiston), piston_rate, piston_rate, piston_compliance_, h_, time};
    motion.load = actuator.piston_area * mean(kPressure);
    motion.seen = &seen;
    state.inputs(kPistonForce) = sum_over<Site::piston>(effects, acting_, state.effects, motion, keep);

    AttachPoint<S> attach_point{state.spring_force, h_};
    const S attach_motion = sum_over<Site::structure>(effects, acting_, state.effects, attach_point, keep);
    const S linear_deflection = mean(kPiston) - actuator.moment_arm * mean(kAngle);
    Spring<S> spring = spring_around(
        around, Spring<S>{linear_deflection - attach_motion, mean(kAngle), actuator.moment_arm, actuator.moment_arm,
                          stiffness_, actuator.stiffness, parameters_.structure.stiffness, h_, time, &seen});
    pass_through<Site::load_spring>(effects, acting_, state.effects, spring, keep);
    state.spring_force = stiffness_ * spring.deflection;
    state.inputs(kSpringForce) = state.spring_force - stiffness_ * linear_deflection;
    spring.seen = nullptr;
    return spring;
  }

  /// The engine over a predicted step, under the spring that `evaluate_actuator` found: fills the torque.
  template <class Around>
  void evaluate_engine(State& state, const Advance& advance, const Spring<S>& spring, const Around& around,
                       Keep keep) const noexcept {
    const S angle_rate = advance.rate(kAngle, h_);
    const Surroundings<S> seen = around_state(state, advance.middle, advance.time);
    Motion<S> motion{advance.mean(kAngle), angle_rate, angle_rate, engine_compliance_, h_, advance.time};
    motion.load = state.spring_force;
    motion.seen = &seen;
    look_around(around, motion);
    const S own = sum_over<Site::engine_torque>(parameters_.effects, acting_, state.effects, motion, keep);
    state.inputs(kEngineTorque) =
        torque_around(around, own) - (spring.arm - parameters_.actuator.moment_arm) * state.spring_force;
  }

  template <class Around>
  void evaluate(State& state, const Advance& advance, const Around& around, Keep keep) const noexcept {
    const Spring<S> spring = evaluate_actuator(state, advance, around, keep);
    evaluate_engine(state, advance, spring, around, keep);
  }

  /// Closes a step with the inputs of the last evaluation.
  void finish(State& state, const Advance& advance) const noexcept {
    state.y = advance.free + times(hold_.response, state.inputs);
    state.clock.steps += 1.0;
    measure(state);
  }

  /// Readings of the sensors, in the order of `channels`.
  static const std::array<S, 3>& measured(const State& state) noexcept { return state.measured; }

 private:
  /// A step of several cycles of the oil's resonance can remove more flow than is added. A law that takes nearly all
  /// compliance from the oil would then have no solution.
  static constexpr double kMostRelief = 0.95;

  static Spring<S> spring_around(const Uncoupled&, const Spring<S>& own) noexcept { return own; }
  static Spring<S> spring_around(const Coupling<S>& around, Spring<S> own) noexcept {
    own.deflection = own.deflection - around.motion;
    own.arm = around.arm;
    return own;
  }
  static void look_around(const Uncoupled&, Motion<S>&) noexcept {}
  static void look_around(const Coupling<S>& around, Motion<S>& own) noexcept {
    own.other_angle = around.other_angle;
    own.other_rate = around.other_rate;
  }
  static S torque_around(const Uncoupled&, const S& own) noexcept { return own; }
  static S torque_around(const Coupling<S>& around, const S& own) noexcept { return own + around.torque; }

  Surroundings<S> around_state(const State& state, const Eigen::Matrix<S, 8, 1>& y, const Precise<S>& time) const noexcept {
    return {y, state.inputs(kCommand), parameters_.servovalve, parameters_.actuator, time};
  }

  /// The command of the torque motor before saturation, with the axis at `y`.
  S torque_motor(const State& state, const Eigen::Matrix<S, 8, 1>& y) const noexcept {
    const Servovalve<S>& valve = parameters_.servovalve;
    return valve.position_gain * (state.inputs(kCommand) - valve.position_feedback * y(kPiston)) -
           valve.pressure_feedback_gain * (y(kPressure) - y(kWashout));
  }
  static S saturated(const S& command) noexcept { return clamp_symmetric<S>(command, S{1.0}); }

  /// The opening of the spool at a position, and the flow through the valve's orifices under a load pressure.
  Hydraulics<S> hydraulics(State& state, const S& spool, const S& pressure, const Surroundings<S>& seen,
                           Keep keep) const noexcept {
    Signal<S> valve{spool, h_, seen.time, S{0.0}, &seen};
    pass_through<Site::valve>(parameters_.effects, acting_, state.effects, valve, keep);
    const S& opening = valve.value;
    const S& supply = parameters_.actuator.supply_pressure;
    const S drop = 1.0 - sign_of(opening) * pressure / supply;
    // The root's slope is infinite at zero drop; below 1e-9 of the supply the flow is zero to any sensor.
    const S flow = parameters_.servovalve.rated_flow * opening * sqrt(select(value_of(drop) > 1e-9, drop, S{1e-9}));
    return {pressure, opening, supply, h_, seen.time, flow, &seen};
  }

  Precise<S> mid_step(const State& state) const noexcept { return state.clock.at(h_, 0.5); }

  Advance at_rest(const State& state) const noexcept {
    return {state.y, state.y, state.y, state.y, S{0.0}, mid_step(state)};
  }

  template <class Around>
  S excess_force(State& state, const S& angle, const Around& around) const noexcept;
  template <class Around>
  S net_flow(State& state, const Around& around) const noexcept;
  template <class FlowAt>
  void rest_in_play(State& state, double piston, FlowAt&& flow_at) const;

  void measure(State& state) const noexcept {
    const std::array<S, 3> truth{state.y(kPiston), state.y(kAngle), state.y(kPressure)};
    if (!acting_.template any<Site::sensor>()) {
      state.measured = truth;
      return;
    }
    const Surroundings<S> seen = around_state(state, state.y, state.clock.at(h_));
    for (std::size_t channel = 0; channel < truth.size(); ++channel) {
      state.measured[channel] =
          pass_through_sensor<S, List>(static_cast<int>(channel), parameters_.effects, acting_, state.effects,
                                       Signal<S>{truth[channel], h_, state.clock.at(h_), S{0.0}, &seen});
    }
  }

  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
  S stiffness_{0.0};
  ExactHold<S, 8, 6> hold_;
  S piston_compliance_{0.0};
  S engine_compliance_{0.0};
  S flow_relief_{0.0};
};

}  // namespace hotfire::model

#include "model/actuator/axis_rest.hpp"
