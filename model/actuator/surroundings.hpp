// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "model/actuator/parts.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Continuous states of an axis, in their order.
struct AxisStates {
  enum Index { kOpening, kOpeningRate, kPressure, kWashout, kPiston, kPistonRate, kAngle, kAngleRate };
};

/// The quantities on which a term may depend: those of an axis that exist at every site.
enum class Argument {
  command,        ///< beta_c, of the axis [rad]
  error,          ///< R beta_c less the position that is fed back, of the position loop [m]
  valve_command,  ///< of the torque motor, saturated, before its effects [1]
  spool,          ///< [1]
  flow,           ///< of the declared orifices at that spool position and load pressure [m^3/s]
  load_pressure,  ///< [Pa]
  position,       ///< of the piston [m]
  rate,           ///< of the piston [m/s]
  angle,          ///< of the engine [rad]
  angle_rate,     ///< of the engine [rad/s]
  deflection,     ///< x_p - R beta [m]
  time            ///< of the record [s]
};
inline constexpr std::array<std::string_view, 12> kArgumentNames{"command", "error",         "valve_command", "spool",
                                                                 "flow",    "load_pressure", "position",      "rate",
                                                                 "angle",   "angle_rate",    "deflection",    "time"};
inline constexpr std::array<std::string_view, 12> kArgumentUnits{"rad", "m",   "1",   "1",     "m^3/s", "Pa",
                                                                 "m",   "m/s", "rad", "rad/s", "m",     "s"};

/// The axis around a site over one step. It holds references: a quantity is computed only if a term reads it.
template <class S>
struct Surroundings : AxisStates {
  const Eigen::Matrix<S, 8, 1>& y;  ///< continuous states, mean over the step, in the order of `AxisStates`
  const S& piston_command;          ///< R beta_c [m]
  const Servovalve<S>& valve;
  const Actuator<S>& actuator;
  Precise<S> time;  ///< of the record, mean over the step [s]

  Surroundings(const Eigen::Matrix<S, 8, 1>& states, const S& commanded, const Servovalve<S>& own_valve,
               const Actuator<S>& own_actuator, const Precise<S>& now) noexcept
      : y(states), piston_command(commanded), valve(own_valve), actuator(own_actuator), time(now) {}

  S at(Argument argument) const noexcept {
    switch (argument) {
      case Argument::command:
        return piston_command / actuator.moment_arm;
      case Argument::error:
        return piston_command - valve.position_feedback * y(kPiston);
      case Argument::valve_command:
        return clamp_symmetric<S>(valve.position_gain * (piston_command - valve.position_feedback * y(kPiston)) -
                                      valve.pressure_feedback_gain * (y(kPressure) - y(kWashout)),
                                  S{1.0});
      case Argument::spool:
        return y(kOpening);
      case Argument::flow: {
        // The root's slope is infinite at zero drop; below a billionth of the supply pressure the flow is zero.
        const S drop = 1.0 - sign_of(y(kOpening)) * y(kPressure) / actuator.supply_pressure;
        return valve.rated_flow * y(kOpening) * sqrt(select(value_of(drop) > 1e-9, drop, S{1e-9}));
      }
      case Argument::load_pressure:
        return y(kPressure);
      case Argument::position:
        return y(kPiston);
      case Argument::rate:
        return y(kPistonRate);
      case Argument::angle:
        return y(kAngle);
      case Argument::angle_rate:
        return y(kAngleRate);
      case Argument::deflection:
        return y(kPiston) - actuator.moment_arm * y(kAngle);
      case Argument::time:
        return S(time);
    }
    return S{0.0};
  }
};

}  // namespace hotfire::model
