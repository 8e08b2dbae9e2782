// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cmath>

#include "model/effects/load/soft_stiffness.hpp"
#include "model/friction/friction.hpp"
#include "model/simplex.hpp"

namespace hotfire::test {

/// One hydraulic axis as x' = f(x) (docs/physics.md, section 1) with a dead band, a soft spring by the law `compliance` and
/// LuGre friction of the gimbal: what a general-purpose solver integrates. S is double, or a dual number for the Jacobian.
/// The laws that are functions of a force or a speed are the model's own.
struct AxisEquations {
  enum State { kSpool, kSpoolRate, kPressure, kWashout, kPiston, kPistonRate, kAngle, kAngleRate, kBristle, kStates };
  static constexpr int size = kStates;
  using Parameters = model::Simplex<double>::Parameters;

  const Parameters* parameters;
  double deadband;
  model::SoftStiffness::Params<double> soft;
  bool is_soft;
  model::GimbalFriction::Params<double> friction;
  bool rubs;
  double command = 0.0;               ///< [rad]
  mutable double spring_guess = 0.0;  ///< force of the spring at the last evaluation [N]

  template <class S>
  using Vector = Eigen::Matrix<S, size, 1>;

  void derivative(const Vector<double>& x, Vector<double>& rate) const noexcept { rates<double>(x, rate); }

  /// By dual numbers.
  void jacobian(const Vector<double>& x, Eigen::Matrix<double, size, size>& all) const noexcept {
    using Dual = ceres::Jet<double, size>;
    Vector<Dual> point;
    Vector<Dual> rate;
    for (int i = 0; i < size; ++i) {
      point(i) = Dual(x(i), i);
    }
    rates<Dual>(point, rate);
    for (int i = 0; i < size; ++i) {
      all.row(i) = rate(i).v.transpose();
    }
  }

  template <class S>
  void rates(const Vector<S>& x, Vector<S>& rate) const noexcept {
    using std::sqrt;
    const auto& valve = parameters->servovalve;
    const auto& actuator = parameters->actuator;
    const auto& engine = parameters->engine;
    const double frequency = valve.natural_frequency;
    const S asked = model::clamp_symmetric<S>(valve.position_gain * (actuator.moment_arm * command - x(kPiston)) -
                                                  valve.pressure_feedback_gain * (x(kPressure) - x(kWashout)),
                                              S{1.0});
    rate(kSpool) = x(kSpoolRate);
    rate(kSpoolRate) = frequency * frequency * (asked - x(kSpool)) - 2.0 * valve.damping_ratio * frequency * x(kSpoolRate);
    const S opening = x(kSpool) - model::clamp_symmetric<S>(x(kSpool), S{deadband});
    const S drop = 1.0 - model::sign_of(opening) * x(kPressure) / actuator.supply_pressure;
    const S flow = valve.rated_flow * opening * sqrt(model::value_of(drop) > 1e-9 ? drop : S{1e-9});
    rate(kPressure) = 4.0 * actuator.bulk_modulus / actuator.trapped_volume *
                      (flow - actuator.piston_area * x(kPistonRate) - actuator.leakage * x(kPressure));
    rate(kWashout) = valve.pressure_feedback_corner * (x(kPressure) - x(kWashout));
    const S force = spring_force<S>(x(kPiston) - actuator.moment_arm * x(kAngle));
    rate(kPiston) = x(kPistonRate);
    rate(kPistonRate) =
        (actuator.piston_area * x(kPressure) - force - actuator.piston_damping * x(kPistonRate)) / actuator.piston_mass;
    rate(kAngle) = x(kAngleRate);
    S torque = engine.duct_stiffness * x(kAngle) + engine.viscous_damping * x(kAngleRate);
    rate(kBristle) = S{0.0};
    if (rubs) {
      const S speed = x(kAngleRate) * model::sign_of(x(kAngleRate));
      const S level = model::stribeck_level<S>(speed, S{friction.coulomb_torque}, S{friction.static_ratio},
                                               S{friction.stribeck_velocity});
      rate(kBristle) = x(kAngleRate) - friction.stiffness * speed / level * x(kBristle);
      torque += friction.stiffness * x(kBristle) +
                model::passive_damping<S>(S{friction.damping}, S{friction.coulomb_torque}, speed) * rate(kBristle);
    }
    rate(kAngleRate) = (actuator.moment_arm * force - torque) / engine.inertia;
  }

  /// Solved from the force of the last evaluation.
  template <class S>
  S spring_force(const S& deflection) const noexcept {
    const double stiffness = 1.0 / (1.0 / parameters->actuator.stiffness + 1.0 / parameters->structure.stiffness);
    if (!is_soft) {
      return stiffness * deflection;
    }
    model::SoftStiffness::Params<S> law;
    law.low_stiffness = S{soft.low_stiffness};
    law.load_scale = S{soft.load_scale};
    model::SoftStiffness::State<S> guess{spring_guess};
    const model::Spring<S> spring{deflection,
                                  S{0.0},
                                  S{1.0},
                                  S{1.0},
                                  S{stiffness},
                                  S{parameters->actuator.stiffness},
                                  S{parameters->structure.stiffness}};
    const S force = stiffness * model::SoftStiffness::step(law, guess, spring).deflection;
    spring_guess = guess.magnitude;
    return force;
  }
};

}  // namespace hotfire::test
