// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "model/declaration/field.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The declared parameters of the parts of an electromechanical actuator. Motor and drive are in SI. The load is in the
/// consistent set of the record, in which a force is a torque [N m] times the ratio of the transmission [rad/position].

/// The controller of the actuator, continuous in time: the motor's command is
///     proportional_gain error + integral_gain integral(error) - derivative_gain motor speed,
///     error = command - position_feedback position - velocity_feedback motor speed,
/// all counted at the load. A cascade of a proportional position loop and a PI speed loop is `velocity_feedback` = 1 / the
/// gain of the position loop.
template <class S>
struct Controller {
  using Scalar = S;
  static constexpr std::string_view name = "controller";
  S proportional_gain{1.0};
  S integral_gain{0.0};
  S derivative_gain{0.0};
  S position_feedback{0.0};
  S velocity_feedback{0.0};
  S load_feedback{0.0};
  S limit{0.0};
  static constexpr auto fields() {
    using P = Controller;
    return std::array{
        Field<P>{"proportional_gain", "command/position", 0.0, 1e12, 1.0, "motor command per error", &P::proportional_gain},
        Field<P>{"integral_gain", "command/position/time", 0.0, 1e12, 0.0, "motor command per integral of the error",
                 &P::integral_gain},
        Field<P>{"derivative_gain", "command.time/position", 0.0, 1e12, 0.0, "motor command per motor speed, against it",
                 &P::derivative_gain},
        Field<P>{"position_feedback", "1", 0.0, 10.0, 0.0, "position in the error, per position; 0: no position loop",
                 &P::position_feedback},
        Field<P>{"velocity_feedback", "time", 0.0, 1e6, 0.0, "motor speed in the error", &P::velocity_feedback},
        Field<P>{"load_feedback", "1", 0.0, 1.0, 0.0, "share of the load's position in the fed back one; 0: of the motor's",
                 &P::load_feedback},
        Field<P>{"limit", "command", 0.0, 1e12, 0.0,
                 "largest motor command; the integral waits where it is reached; 0: none", &P::limit}};
  }
};

/// The motor with its drive. Its command is a current that the drive controls with the corner `current_corner`, or a voltage
/// on the winding: inductance i' = voltage - resistance i - torque_constant speed.
template <class S>
struct Motor {
  using Scalar = S;
  static constexpr std::string_view name = "motor";
  S torque_constant{1.0};
  S inertia{1.0};
  S damping{0.0};
  S current_corner{0.0};
  S resistance{0.0};
  S inductance{0.0};
  static constexpr auto fields() {
    using P = Motor;
    return std::array{
        Field<P>{"torque_constant", "N.m/A", 1e-9, 1e6, 1.0, "torque per current, and voltage per speed",
                 &P::torque_constant},
        Field<P>{"inertia", "kg.m^2", 1e-12, 1e6, 1.0, "inertia of the rotor", &P::inertia},
        Field<P>{"damping", "N.m.s/rad", 0.0, 1e6, 1.0, "viscous damping of the rotor", &P::damping},
        Field<P>{"current_corner", "rad/s", 0.0, 1e6, 0.0, "corner of a drive that controls the current; 0: voltage drive",
                 &P::current_corner},
        Field<P>{"resistance", "ohm", 0.0, 1e6, 0.0, "resistance of the winding, of a voltage drive", &P::resistance},
        Field<P>{"inductance", "H", 0.0, 1e3, 0.0, "inductance of the winding, of a voltage drive", &P::inductance}};
  }

  bool has_current_drive() const noexcept { return value_of(current_corner) > 0.0; }

  static std::string_view broken_relation(const Motor& motor) noexcept {
    const bool has_winding = value_of(motor.resistance) > 0.0 && value_of(motor.inductance) > 0.0;
    const bool has_neither = !(value_of(motor.resistance) > 0.0) && !(value_of(motor.inductance) > 0.0);
    return (motor.has_current_drive() ? has_neither : has_winding)
               ? std::string_view()
               : "needs either current_corner (the command is a current), or resistance and inductance (it is a voltage)";
  }
};

/// Screw, gear or belt between motor and load.
template <class S>
struct Transmission {
  using Scalar = S;
  static constexpr std::string_view name = "transmission";
  S ratio{1.0};
  S stiffness{0.0};
  S damping{0.0};
  static constexpr auto fields() {
    using P = Transmission;
    return std::array{
        Field<P>{"ratio", "rad/position", 1e-9, 1e9, 1.0, "motor angle per position of the load", &P::ratio},
        Field<P>{"stiffness", "force/position", 0.0, 1e15, 1.0, "stiffness at the load; 0: rigid", &P::stiffness},
        Field<P>{"damping", "force.time/position", 0.0, 1e12, 1.0, "viscous damping beside the stiffness", &P::damping}};
  }

  bool is_rigid() const noexcept { return !(value_of(stiffness) > 0.0); }
};

}  // namespace hotfire::model
