// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "model/actuator/electromechanical_parts.hpp"
#include "model/actuator/parts.hpp"
#include "model/effects.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/exact_hold.hpp"
#include "model/numerics/step_size.hpp"

namespace hotfire::model {

/// An electromechanical actuator: controller, drive, motor, transmission, load. A servo motor on a bench, or a screw that
/// turns an engine. With x_m the motor's angle over the ratio N, and all forces counted at the load:
///
///     current drive: i' = corner (command - i);   voltage drive: L i' = command - R i - K_t N x_m'
///     J N^2 x_m'' + d N^2 x_m' = K_t N i - spring - motor effects
///     inertia x'' + damping x' + stiffness x = spring - effects,   spring = k (x_m - x) + c (x_m' - x') - transmission
///     effects
///
/// The motor's command is that of the `Controller`, limited, after the effects of the drive. Without a stiffness the
/// transmission is rigid and x_m = x.
///
/// Discretised as `Simplex` is: exact hold of the linear part, controller included; limit and effects held at the mean of
/// the step's ends, two passes. Second order where the model is smooth.
template <class S, class List = ElectromechanicalEffects>
class Electromechanical {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view topology = "electromechanical";
  static constexpr std::string_view input_channel = "setpoint";
  enum Channel { kPosition, kVelocity, kMotorPosition, kMotorVelocity, kCurrent };
  static constexpr std::array<std::string_view, 5> channels{"position", "velocity", "motor_position", "motor_velocity",
                                                            "current"};
  static constexpr std::array<std::string_view, 5> channel_units{"", "", "rad", "rad/s", "A"};
  static constexpr std::string_view input_unit = "";
  static constexpr int kPasses = 2;

  struct Parameters {
    Controller<S> controller;
    Motor<S> motor;
    Transmission<S> transmission;
    Mass<S> mass;
    EffectParameters<S, List> effects;

    template <class Self, class F>
    static constexpr void for_each_part(Self& self, F&& f) {
      f(self.controller);
      f(self.motor);
      f(self.transmission);
      f(self.mass);
    }

    /// Why nothing can act at a site of this actuator; empty if something can.
    std::string_view missing_place(Site site) const noexcept {
      return transmission.is_rigid() && (site == Site::motor || site == Site::transmission)
                 ? "needs transmission.stiffness: a rigid transmission has no play, and motor and load share one friction"
                 : std::string_view();
    }
  };

  enum Index { kIntegral, kAmperes, kMotor, kMotorRate, kLoad, kLoadRate };
  /// Inputs that are held over a step: command; motor command beyond the linear one; rate of the integral beyond the error;
  /// forces against motor, spring and load.
  enum Input { kCommand, kMotorCommand, kIntegralRate, kMotorForce, kSpringForce, kLoadForce };

  struct State {
    Eigen::Matrix<S, 6, 1> y = Eigen::Matrix<S, 6, 1>::Zero();  ///< in the order of `Index`
    Eigen::Matrix<S, 6, 1> inputs = Eigen::Matrix<S, 6, 1>::Zero();
    Clock<S> clock{};  ///< time of the record, for effects that depend on it
    EffectStates<S, List> effects{};
    std::array<S, 5> measured{};
  };

  /// The longest step [s] at these parameters: a fifth of a cycle of motor and load on the transmission, as of a `Simplex`.
  static double longest_step(const Parameters& parameters) noexcept {
    constexpr double kStepsInCycle = 5.0;
    if (parameters.transmission.is_rigid()) {
      return kLongestStep;
    }
    const double ratio = value_of(parameters.transmission.ratio);
    const double softness =
        1.0 / (value_of(parameters.motor.inertia) * ratio * ratio) + 1.0 / value_of(parameters.mass.inertia);
    const double turn = std::sqrt(value_of(parameters.transmission.stiffness) * softness);
    return std::clamp(2.0 * std::numbers::pi / turn / kStepsInCycle, kShortestStep, kLongestStep);
  }

  Electromechanical(const Parameters& parameters, double h)
      : parameters_(parameters),
        acting_(parameters.effects.active),
        h_(h),
        force_constant_(parameters.motor.torque_constant * parameters.transmission.ratio),
        load_(parameters.transmission.is_rigid() ? kMotor : kLoad) {
    const Controller<S>& controller = parameters_.controller;
    const Motor<S>& motor = parameters_.motor;
    const Transmission<S>& transmission = parameters_.transmission;
    const Mass<S>& mass = parameters_.mass;
    const S squared = transmission.ratio * transmission.ratio;
    const bool rigid = transmission.is_rigid();
    const S rotor = rigid ? S(motor.inertia * squared + mass.inertia) : S(motor.inertia * squared);
    const S& body = rigid ? rotor : mass.inertia;
    const S per_command = motor.has_current_drive() ? motor.current_corner : S(1.0 / motor.inductance);

    Eigen::Matrix<S, 6, 6> linear = Eigen::Matrix<S, 6, 6>::Zero();
    const Eigen::Matrix<S, 1, 6> error = error_row();
    linear.row(kIntegral) = error;
    linear.row(kAmperes) = S(per_command * controller.proportional_gain) * error;
    linear(kAmperes, kIntegral) += per_command * controller.integral_gain;
    linear(kAmperes, kMotorRate) -= per_command * controller.derivative_gain;
    linear(kAmperes, kAmperes) -= motor.has_current_drive() ? motor.current_corner : S(motor.resistance / motor.inductance);
    linear(kAmperes, kMotorRate) -= motor.has_current_drive() ? S{0.0} : S(force_constant_ / motor.inductance);
    linear(kMotor, kMotorRate) = S{1.0};
    linear(kMotorRate, kAmperes) = force_constant_ / rotor;
    linear(kMotorRate, kMotorRate) -= motor.damping * squared / rotor;
    if (!rigid) {
      linear(kLoad, kLoadRate) = S{1.0};
      linear(kMotorRate, kMotor) -= transmission.stiffness / rotor;
      linear(kMotorRate, kLoad) += transmission.stiffness / rotor;
      linear(kMotorRate, kMotorRate) -= transmission.damping / rotor;
      linear(kMotorRate, kLoadRate) += transmission.damping / rotor;
      linear(kLoadRate, kMotor) += transmission.stiffness / body;
      linear(kLoadRate, kLoad) -= transmission.stiffness / body;
      linear(kLoadRate, kMotorRate) += transmission.damping / body;
      linear(kLoadRate, kLoadRate) -= transmission.damping / body;
    }
    linear(load_ + 1, load_) -= mass.stiffness / body;
    linear(load_ + 1, load_ + 1) -= mass.damping / body;

    Eigen::Matrix<S, 6, 6> driven = Eigen::Matrix<S, 6, 6>::Zero();
    driven(kIntegral, kCommand) = S{1.0};
    driven(kIntegral, kIntegralRate) = S{1.0};
    driven(kAmperes, kCommand) = per_command * controller.proportional_gain;
    driven(kAmperes, kMotorCommand) = per_command;
    driven(kMotorRate, kMotorForce) = -1.0 / rotor;
    driven(kMotorRate, kSpringForce) = -1.0 / rotor;
    driven(load_ + 1, kSpringForce) += 1.0 / body;
    driven(load_ + 1, kLoadForce) = -1.0 / body;

    hold_ = exact_hold<S, 6, 6>(linear, driven, h);
    motor_compliance_ = -hold_.response(kMotor, kMotorForce) / h;
    load_compliance_ = -hold_.response(load_, kLoadForce) / h;
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// What a step makes of the continuous states without inputs.
  const Eigen::Matrix<S, 6, 6>& transition() const noexcept { return hold_.transition; }

  /// Where the actuator rests under a constant command, by its linear part: with a position loop where the command, or the
  /// spring to ground, leaves it; without one at zero.
  S resting_position(const S& command) const noexcept {
    const Controller<S>& controller = parameters_.controller;
    if (!(value_of(controller.position_feedback) > 0.0)) {
      return S{0.0};
    }
    if (value_of(controller.integral_gain) > 0.0) {
      return command / controller.position_feedback;
    }
    const S gain = controller.proportional_gain * amperes(S{1.0}) * force_constant_;
    return gain * command / (gain * controller.position_feedback + parameters_.mass.stiffness);
  }

  /// At rest there.
  State steady(const S& command) const { return resting(command, resting_position(command)); }

  /// At rest under a constant command with the load at `position`: set-up only. A controller with an integral holds it,
  /// without one the friction does. The transmission is loaded by what holds the load.
  State resting(const S& command, const S& position) const {
    State state;
    Signal<S> commanded{command, h_};
    settle<Site::command>(parameters_.effects, state.effects, commanded);
    pass_through<Site::command>(parameters_.effects, acting_, state.effects, commanded, Keep::no);
    state.inputs(kCommand) = commanded.value;
    Motion<S> still = motion_of(position, S{0.0}, load_compliance_, state.clock.at(h_));
    const S load = parameters_.mass.stiffness * position +
                   sum_over<Site::mass_force>(parameters_.effects, acting_, state.effects, still, Keep::no);
    const bool rigid = parameters_.transmission.is_rigid();
    state.y(load_) = position;
    state.y(kMotor) = rigid ? position : S(position + load / parameters_.transmission.stiffness);
    const Controller<S>& controller = parameters_.controller;
    const S proportional = controller.proportional_gain * error(state, state.y);
    if (value_of(controller.integral_gain) > 0.0) {
      state.y(kAmperes) = load / force_constant_;
      state.y(kIntegral) = (state.y(kAmperes) / amperes(S{1.0}) - proportional) / controller.integral_gain;
    } else {
      state.y(kAmperes) = amperes(limited(proportional));
    }
    measure(state);
    return state;
  }

  /// Advances by one step with the command held.
  void step(State& state, const S& command) const noexcept {
    const auto& effects = parameters_.effects;
    const Precise<S> time = state.clock.at(h_, 0.5);
    Signal<S> commanded{command, h_, time};
    pass_through<Site::command>(effects, acting_, state.effects, commanded, Keep::yes);
    state.inputs(kCommand) = commanded.value;
    const Eigen::Matrix<S, 6, 1> start = state.y;
    const Eigen::Matrix<S, 6, 1> free = times(hold_.transition, start);
    for (int pass = 0; pass < kPasses; ++pass) {
      const Eigen::Matrix<S, 6, 1> end = free + times(hold_.response, state.inputs);
      evaluate(state, start, end, time, pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    state.y = free + times(hold_.response, state.inputs);
    state.clock.steps += 1.0;
    measure(state);
  }

  static const std::array<S, 5>& measured(const State& state) noexcept { return state.measured; }

  /// Position and speed of the load.
  const S& load_position(const State& state) const noexcept { return state.y(load_); }
  const S& load_rate(const State& state) const noexcept { return state.y(load_ + 1); }
  /// Of the transmission, counted at the load.
  S twist(const State& state) const noexcept { return load_ == kMotor ? S{0.0} : S(state.y(kMotor) - state.y(kLoad)); }
  /// The motor's force, counted at the load.
  S motor_force(const State& state) const noexcept { return force_constant_ * state.y(kAmperes); }
  /// The output of the controller, limited.
  S motor_command(const State& state) const noexcept { return limited(linear_command(state, state.y)); }

 private:
  /// The error per state, without the command.
  Eigen::Matrix<S, 1, 6> error_row() const noexcept {
    const Controller<S>& controller = parameters_.controller;
    Eigen::Matrix<S, 1, 6> row = Eigen::Matrix<S, 1, 6>::Zero();
    row(load_) -= controller.position_feedback * controller.load_feedback;
    row(kMotor) -= controller.position_feedback * (1.0 - controller.load_feedback);
    row(kMotorRate) -= controller.velocity_feedback;
    return row;
  }

  S error(const State& state, const Eigen::Matrix<S, 6, 1>& y) const noexcept {
    const Controller<S>& controller = parameters_.controller;
    const S position = controller.load_feedback * y(load_) + (1.0 - controller.load_feedback) * y(kMotor);
    return state.inputs(kCommand) - controller.position_feedback * position - controller.velocity_feedback * y(kMotorRate);
  }

  S linear_command(const State& state, const Eigen::Matrix<S, 6, 1>& y) const noexcept {
    const Controller<S>& controller = parameters_.controller;
    return controller.proportional_gain * error(state, y) + controller.integral_gain * y(kIntegral) -
           controller.derivative_gain * y(kMotorRate);
  }

  S limited(const S& command) const noexcept {
    const S& limit = parameters_.controller.limit;
    return value_of(limit) > 0.0 ? clamp_symmetric<S>(command, limit) : command;
  }

  /// The current of a motor command on a motor at rest.
  S amperes(const S& command) const noexcept {
    return parameters_.motor.has_current_drive() ? command : S(command / parameters_.motor.resistance);
  }

  Motion<S> motion_of(const S& position, const S& rate, const S& compliance, const Precise<S>& time) const noexcept {
    Motion<S> motion{position, rate, rate, compliance, h_, time};
    motion.declared_stiffness = parameters_.mass.stiffness;
    motion.declared_damping = parameters_.mass.damping;
    return motion;
  }

  /// Fills the inputs of a step from its ends.
  void evaluate(State& state, const Eigen::Matrix<S, 6, 1>& start, const Eigen::Matrix<S, 6, 1>& end, const Precise<S>& time,
                Keep keep) const noexcept {
    const auto& effects = parameters_.effects;
    const Eigen::Matrix<S, 6, 1> mean = S(0.5) * (start + end);
    const S wanted = linear_command(state, mean);
    const S allowed = limited(wanted);
    Signal<S> drive{allowed, h_, time};
    pass_through<Site::drive>(effects, acting_, state.effects, drive, keep);
    state.inputs(kMotorCommand) = drive.value - wanted;
    const S left = error(state, mean);
    const bool waits = value_of(allowed) != value_of(wanted) && value_of(left) * value_of(wanted) > 0.0;
    state.inputs(kIntegralRate) = waits ? S(-left) : S{0.0};

    const S motor_rate = (end(kMotor) - start(kMotor)) / h_;
    Motion<S> motor{mean(kMotor), motor_rate, motor_rate, motor_compliance_, h_, time};
    state.inputs(kMotorForce) = sum_over<Site::motor>(effects, acting_, state.effects, motor, keep);

    if (acting_.template any<Site::transmission>()) {
      const S& stiffness = parameters_.transmission.stiffness;
      const S deflection = mean(kMotor) - mean(kLoad);
      Spring<S> spring{deflection, mean(kLoad), S{1.0}, S{1.0}, stiffness, stiffness, stiffness, h_, time};
      pass_through<Site::transmission>(effects, acting_, state.effects, spring, keep);
      state.inputs(kSpringForce) = stiffness * (spring.deflection - deflection);
    }

    const S load_rate = (end(load_) - start(load_)) / h_;
    Motion<S> load = motion_of(mean(load_), load_rate, load_compliance_, time);
    state.inputs(kLoadForce) = sum_over<Site::mass_force>(effects, acting_, state.effects, load, keep);
  }

  void measure(State& state) const noexcept {
    const S& ratio = parameters_.transmission.ratio;
    state.measured = {state.y(load_), state.y(load_ + 1), S(ratio * state.y(kMotor)), S(ratio * state.y(kMotorRate)),
                      state.y(kAmperes)};
  }

  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
  S force_constant_;
  int load_;  ///< index of the load's position; of a rigid transmission the motor's
  ExactHold<S, 6, 6> hold_;
  S motor_compliance_{0.0};
  S load_compliance_{0.0};
};

}  // namespace hotfire::model
