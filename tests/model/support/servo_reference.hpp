// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "model/electromechanical.hpp"

namespace hotfire::test {

/// What acts on a servo beside its declared parts.
struct ServoEffects {
  using Force = std::function<double(double position, double rate)>;
  Force on_motor = nullptr;  ///< counted at the load
  Force on_load = nullptr;
  std::function<double(double)> drive = nullptr;  ///< of the motor's command
  double half_play = 0.0;                         ///< of the transmission
};

/// The equations of an electromechanical actuator with an elastic transmission, written out once more and solved by the
/// classical Runge-Kutta method. It shares the parameters with the model, and no code.
class ServoReference {
 public:
  /// Integral of the error, current, angle and speed of the motor, position and speed of the load.
  using Vector = std::array<double, 6>;
  explicit ServoReference(const model::Electromechanical<double>::Parameters& parameters, ServoEffects effects = {})
      : p_(parameters), effects_(std::move(effects)) {}

  void advance(Vector& y, double setpoint, double h) const {
    const Vector a = derivative(y, setpoint);
    const Vector b = derivative(along(y, a, 0.5 * h), setpoint);
    const Vector c = derivative(along(y, b, 0.5 * h), setpoint);
    const Vector d = derivative(along(y, c, h), setpoint);
    for (std::size_t i = 0; i < y.size(); ++i) {
      y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
  }

  /// In the order of the plant's channels.
  static std::array<double, 5> readings(const Vector& y) { return {y[4], y[5], y[2], y[3], y[1]}; }

 private:
  static Vector along(Vector y, const Vector& slope, double h) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      y[i] += h * slope[i];
    }
    return y;
  }

  double motor_command(double error, double integral, double speed) const {
    double command = p_.controller.proportional_gain * error + p_.controller.integral_gain * integral -
                     p_.controller.derivative_gain * speed;
    if (p_.controller.limit > 0.0) {
      command = std::clamp(command, -p_.controller.limit, p_.controller.limit);
    }
    return effects_.drive ? effects_.drive(command) : command;
  }

  Vector derivative(const Vector& y, double setpoint) const {
    const auto& [integral, amperes, angle, speed, position, rate] = y;
    const double n = p_.transmission.ratio;
    const double x = angle / n;
    const double v = speed / n;
    const double fed_back = p_.controller.load_feedback * position + (1.0 - p_.controller.load_feedback) * x;
    const double error = setpoint - p_.controller.position_feedback * fed_back - p_.controller.velocity_feedback * v;
    const double command = motor_command(error, integral, v);
    const double twist = x - position;
    const double play = std::clamp(twist, -effects_.half_play, effects_.half_play);
    const double spring = p_.transmission.stiffness * (twist - play) + p_.transmission.damping * (v - rate);
    const double on_motor = effects_.on_motor ? effects_.on_motor(x, v) : 0.0;
    const double on_load = effects_.on_load ? effects_.on_load(position, rate) : 0.0;
    return {error,
            p_.motor.current_corner > 0.0
                ? p_.motor.current_corner * (command - amperes)
                : (command - p_.motor.resistance * amperes - p_.motor.torque_constant * speed) / p_.motor.inductance,
            speed,
            (p_.motor.torque_constant * amperes - p_.motor.damping * speed - (spring + on_motor) / n) / p_.motor.inertia,
            rate,
            (spring - p_.mass.damping * rate - p_.mass.stiffness * position - on_load) / p_.mass.inertia};
  }

  model::Electromechanical<double>::Parameters p_;
  ServoEffects effects_;
};

/// A servo with a voltage drive and a screw: a position loop with an integral, the motor's speed fed back as well.
inline model::Electromechanical<double>::Parameters servo() {
  model::Electromechanical<double>::Parameters parameters;
  parameters.controller = {200.0, 500.0, 1.5, 1.0, 0.02, 0.6, 0.0};
  parameters.motor = {0.1, 1e-4, 1e-4, 0.0, 1.0, 1e-3};
  parameters.transmission = {100.0, 2e4, 5.0};
  parameters.mass = {2.0, 5.0, 300.0};
  return parameters;
}

}  // namespace hotfire::test
