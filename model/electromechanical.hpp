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
#include "model/numerics/root.hpp"
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

  /// The longest step [s] at these parameters: a fifth of a cycle of motor and load on the transmission, as of a `Simplex`,
  /// and a fifth of a radian of the crossover of the speed and position loops, in which a limit or play is held.
  static double longest_step(const Parameters& parameters) noexcept {
    constexpr double kStepsInCycle = 5.0;
    constexpr double kAngle = 0.2;
    const Controller<S>& controller = parameters.controller;
    const double ratio = value_of(parameters.transmission.ratio);
    const double rotor = value_of(parameters.motor.inertia) * ratio * ratio;
    const double load = value_of(parameters.mass.inertia);
    const bool rigid = parameters.transmission.is_rigid();
    const double per_command = value_of(parameters.motor.torque_constant) * ratio /
                               (parameters.motor.has_current_drive() ? 1.0 : value_of(parameters.motor.resistance)) /
                               (rigid ? rotor + load : rotor);
    const double proportional = value_of(controller.proportional_gain);
    const double speed_loop =
        per_command * (proportional * value_of(controller.velocity_feedback) + value_of(controller.derivative_gain));
    const double position_loop = std::sqrt(per_command * proportional * value_of(controller.position_feedback));
    double step = kAngle / std::max({speed_loop, position_loop, kAngle / kLongestStep});
    if (!rigid) {
      const double turn = std::sqrt(value_of(parameters.transmission.stiffness) * (1.0 / rotor + 1.0 / load));
      step = std::min(step, 2.0 * std::numbers::pi / turn / kStepsInCycle);
    }
    return std::clamp(step, kShortestStep, kLongestStep);
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
    error_(load_) -= controller.position_feedback * controller.load_feedback;
    error_(kMotor) -= controller.position_feedback * (1.0 - controller.load_feedback);
    error_(kMotorRate) -= controller.velocity_feedback;
    asked_ = controller.proportional_gain * error_;
    asked_(kIntegral) += controller.integral_gain;
    asked_(kMotorRate) -= controller.derivative_gain;
    linear.row(kIntegral) = error_;
    linear.row(kAmperes) = per_command * asked_;
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
    command_relief_ = -0.5 * times(asked_, Eigen::Matrix<S, 6, 1>(hold_.response.col(kMotorCommand)))(0);
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// Continuous states after a step without inputs.
  const Eigen::Matrix<S, 6, 6>& transition() const noexcept { return hold_.transition; }

  /// At rest under a constant setpoint: where the position loop, or the spring to ground, holds the load; without either at
  /// zero. Set-up only.
  State steady(const S& setpoint) const { return resting(setpoint, resting_position(setpoint)); }

  /// Where that is.
  S resting_position(const S& setpoint) const {
    const Controller<S>& controller = parameters_.controller;
    State state;
    set_command(state, setpoint);
    const S softness = parameters_.transmission.is_rigid() ? S{0.0} : S(1.0 / parameters_.transmission.stiffness);
    const S feedback =
        controller.position_feedback * (1.0 + (1.0 - controller.load_feedback) * parameters_.mass.stiffness * softness);
    const S gain = controller.proportional_gain * amperes(S{1.0}) * force_constant_;
    const bool has_integral = value_of(controller.integral_gain) > 0.0 && value_of(feedback) > 0.0;
    const S holds = has_integral ? feedback : S(gain * feedback + parameters_.mass.stiffness);
    if (!(value_of(holds) > 0.0)) {
      return S{0.0};
    }
    const S linear = (has_integral ? S{1.0} : gain) * state.inputs(kCommand) / holds;
    const double width = 1e-6 * std::abs(value_of(linear)) + 1e-9;
    return root_of_decreasing<S>(linear, width, [&](const S& position) {
      const S load = put_at(state, position);
      const S left = error(state, state.y);
      return has_integral ? left
                          : S(force_constant_ * amperes(driven_by(state, controller.proportional_gain * left)) - load);
    });
  }

  /// At rest under a constant setpoint with the load at `position`: set-up only. A controller with an integral holds it,
  /// without one the friction does. The transmission is loaded by what holds the load. Where that leaves the motor free in a
  /// play it is at `motor` [rad], if that is given.
  State resting(const S& setpoint, const S& position, const S* motor = nullptr) const {
    State state;
    set_command(state, setpoint);
    const S load = put_at(state, position);
    if (motor != nullptr && !parameters_.transmission.is_rigid()) {
      const S own = *motor / parameters_.transmission.ratio;
      if (!(std::abs(value_of(transmitted(state, S(own - position), position, Keep::no).deflection)) > 0.0)) {
        state.y(kMotor) = own;
      }
    }
    const Controller<S>& controller = parameters_.controller;
    const S proportional = controller.proportional_gain * error(state, state.y);
    if (value_of(controller.integral_gain) > 0.0) {
      state.y(kAmperes) = load / force_constant_;
      const S needed = state.y(kAmperes) / amperes(S{1.0});
      const S asked = acting_.template any<Site::drive>()
                          ? root_of_decreasing<S>(needed, 1e-6 * std::abs(value_of(needed)) + 1e-9,
                                                  [&](const S& command) { return needed - driven_by(state, command); })
                          : needed;
      state.y(kIntegral) = (asked - proportional) / controller.integral_gain;
    } else {
      state.y(kAmperes) = amperes(driven_by(state, proportional));
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

  const S& load_position(const State& state) const noexcept { return state.y(load_); }
  const S& load_rate(const State& state) const noexcept { return state.y(load_ + 1); }
  /// Of the transmission, counted at the load.
  S twist(const State& state) const noexcept { return load_ == kMotor ? S{0.0} : S(state.y(kMotor) - state.y(kLoad)); }
  /// The motor's force, counted at the load.
  S motor_force(const State& state) const noexcept { return force_constant_ * state.y(kAmperes); }
  /// The output of the controller, limited.
  S motor_command(const State& state) const noexcept { return limited(linear_command(state, state.y)); }

 private:
  /// A loop that is faster than the step would undo nearly all of a change of the motor's command within it.
  static constexpr double kLeastSteepness = 0.1;

  /// The error of the controller at `y`, and the motor command that it asks for, before the limit.
  S error(const State& state, const Eigen::Matrix<S, 6, 1>& y) const noexcept {
    return state.inputs(kCommand) + times(error_, y)(0);
  }
  S linear_command(const State& state, const Eigen::Matrix<S, 6, 1>& y) const noexcept {
    return parameters_.controller.proportional_gain * state.inputs(kCommand) + times(asked_, y)(0);
  }

  S limited(const S& command) const noexcept {
    const S& limit = parameters_.controller.limit;
    return value_of(limit) > 0.0 ? clamp_symmetric<S>(command, limit) : command;
  }

  /// The current of a motor command on a motor at rest.
  S amperes(const S& command) const noexcept {
    return parameters_.motor.has_current_drive() ? command : S(command / parameters_.motor.resistance);
  }

  /// What the drive makes of the controller's command at rest.
  S driven_by(State& state, const S& command) const noexcept {
    Signal<S> drive{limited(command), h_};
    pass_through<Site::drive>(parameters_.effects, acting_, state.effects, drive, Keep::no);
    return drive.value;
  }

  /// Settles the effects on the setpoint and holds what they make of it.
  void set_command(State& state, const S& setpoint) const {
    Signal<S> commanded{setpoint, h_};
    settle<Site::command>(parameters_.effects, state.effects, commanded);
    pass_through<Site::command>(parameters_.effects, acting_, state.effects, commanded, Keep::no);
    state.inputs(kCommand) = commanded.value;
  }

  /// Puts load and motor at rest, the load at `position`. Returns the force that holds it there.
  S put_at(State& state, const S& position) const {
    const auto& effects = parameters_.effects;
    Motion<S> still = motion_of(position, S{0.0}, load_compliance_, state.clock.at(h_));
    S load =
        parameters_.mass.stiffness * position + sum_over<Site::mass_force>(effects, acting_, state.effects, still, Keep::no);
    state.effects.outputs.fill(S{0.0});
    state.y(load_) = position;
    if (parameters_.transmission.is_rigid()) {
      return load;
    }
    const S twist = load / parameters_.transmission.stiffness;
    state.y(kMotor) = position + twist;
    if (acting_.template any<Site::transmission>()) {
      state.y(kMotor) =
          position + root_of_decreasing<S>(twist, 1e-6 * std::abs(value_of(twist)) + 1e-9, [&](const S& whole) {
            return S(twist - transmitted(state, whole, position, Keep::no).deflection);
          });
    }
    return load;
  }

  /// The spring of the transmission after its effects.
  Spring<S> transmitted(State& state, const S& deflection, const S& position, Keep keep) const noexcept {
    const S& stiffness = parameters_.transmission.stiffness;
    const Precise<S> time = state.clock.at(h_, 0.5);
    Spring<S> spring{deflection, position, S{1.0}, S{1.0}, stiffness, stiffness, stiffness, h_, time};
    pass_through<Site::transmission>(parameters_.effects, acting_, state.effects, spring, keep);
    return spring;
  }

  /// The motor command beyond the linear one over a step: r(n) = D(asked - relief n) - (asked - relief n) - n = 0 by one
  /// step of Newton's method from the last n, with D what limit and drive make of a command, which is linear in parts.
  void drive_motor(State& state, const S& asked, const Precise<S>& time, Keep keep) const noexcept {
    const S allowed = limited(asked);
    Signal<S> drive{allowed, h_, time};
    double slope = value_of(allowed) == value_of(asked) ? 1.0 : 0.0;
    if (acting_.template any<Site::drive>()) {
      const S step = 1e-6 * (allowed + sign_of(allowed));
      Signal<S> further{allowed + step, h_, time};
      pass_through<Site::drive>(parameters_.effects, acting_, state.effects, further, Keep::no);
      pass_through<Site::drive>(parameters_.effects, acting_, state.effects, drive, keep);
      slope *= value_of((further.value - drive.value) / step);
    }
    const S steepness = 1.0 - (1.0 - slope) * command_relief_;
    const S bounded = value_of(steepness) > kLeastSteepness ? steepness : S{kLeastSteepness};
    state.inputs(kMotorCommand) += (drive.value - asked - state.inputs(kMotorCommand)) / bounded;
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
    drive_motor(state, wanted, time, keep);
    const S left = error(state, mean);
    const bool waits = value_of(limited(wanted)) != value_of(wanted) && value_of(left) * value_of(wanted) > 0.0;
    state.inputs(kIntegralRate) = waits ? S(-left) : S{0.0};

    const S motor_rate = (end(kMotor) - start(kMotor)) / h_;
    Motion<S> motor{mean(kMotor), motor_rate, motor_rate, motor_compliance_, h_, time};
    state.inputs(kMotorForce) = sum_over<Site::motor>(effects, acting_, state.effects, motor, keep);

    if (acting_.template any<Site::transmission>()) {
      const S deflection = mean(kMotor) - mean(kLoad);
      const Spring<S> spring = transmitted(state, deflection, mean(kLoad), keep);
      state.inputs(kSpringForce) = parameters_.transmission.stiffness * (spring.deflection - deflection);
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
  S command_relief_{0.0};  ///< by how much a unit of motor command over a step lowers what is asked at its mean
  Eigen::Matrix<S, 1, 6> error_ = Eigen::Matrix<S, 1, 6>::Zero();  ///< by the states, without the setpoint
  Eigen::Matrix<S, 1, 6> asked_ = Eigen::Matrix<S, 1, 6>::Zero();  ///< the same of the motor command
};

}  // namespace hotfire::model
