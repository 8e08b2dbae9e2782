// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "model/effects/load/soft_stiffness.hpp"
#include "model/friction/friction.hpp"
#include "tests/model/cvode/reference_vehicle.hpp"

namespace hotfire::test {

/// Engines with two hydraulic axes each on compliant bearings and one modal structure, as x' = f(x) (docs/physics.md,
/// sections 1 to 3): the equations of `ReferenceVehicle` with constant thrust, written for speed. What an engine does
/// depends on its own states and on six numbers of the structure, which the Jacobian follows.
template <int Engines, int Modes>
struct VehicleEquations {
  static constexpr int kAxisStates = 8;
  static constexpr int kBearing = 2 * kAxisStates;
  static constexpr int kBristle = kBearing + 6;
  static constexpr int kEngineStates = kBristle + 2;
  static constexpr int kModes = Engines * kEngineStates;
  static constexpr int size = kModes + 2 * Modes;
  enum AxisState { kSpool, kSpoolRate, kPressure, kWashout, kPiston, kPistonRate, kAngle, kAngleRate };

  template <class S>
  using Vector = Eigen::Matrix<S, size, 1>;
  template <class S>
  using EngineVector = Eigen::Matrix<S, kEngineStates, 1>;
  template <class S>
  using Three = Eigen::Matrix<S, 3, 1>;
  template <class S>
  using Two = Eigen::Matrix<S, 2, 1>;
  /// Of an engine: both attach points pulled together, and the turn of the base and its rate about pitch and yaw.
  template <class S>
  using Base = Eigen::Matrix<S, 6, 1>;
  /// On the structure: both forces, both torques.
  template <class S>
  using Push = Eigen::Matrix<S, 4, 1>;

  const ReferenceVehicle* vehicle;
  std::array<double, static_cast<std::size_t>(2 * Engines)> commands{};              ///< [rad]
  mutable std::array<double, static_cast<std::size_t>(2 * Engines)> spring_guess{};  ///< forces of the last evaluation [N]

  void derivative(const Vector<double>& x, Vector<double>& rate) const noexcept {
    for (int k = 0; k < Modes; ++k) {
      mode_rates(x, k, rate);
    }
    for (int e = 0; e < Engines; ++e) {
      EngineVector<double> own;
      Push<double> push;
      engine(e, EngineVector<double>(x.template segment<kEngineStates>(e * kEngineStates)), base_of(x, e), own, push);
      rate.template segment<kEngineStates>(e * kEngineStates) = own;
      for (int k = 0; k < Modes; ++k) {
        rate(kModes + 2 * k + 1) += shape(k, e).dot(push);
      }
    }
  }

  /// By dual numbers over the states of each engine and its base.
  void jacobian(const Vector<double>& x, Eigen::Matrix<double, size, size>& all) const noexcept {
    constexpr int kSeeds = kEngineStates + 6;
    using Dual = ceres::Jet<double, kSeeds>;
    all.setZero();
    for (int k = 0; k < Modes; ++k) {
      const double w = frequency(k);
      all(kModes + 2 * k, kModes + 2 * k + 1) = 1.0;
      all(kModes + 2 * k + 1, kModes + 2 * k) = -w * w;
      all(kModes + 2 * k + 1, kModes + 2 * k + 1) = -2.0 * vehicle->modes[static_cast<std::size_t>(k)].damping * w;
    }
    for (int e = 0; e < Engines; ++e) {
      const int first = e * kEngineStates;
      EngineVector<Dual> point;
      Base<Dual> base;
      const Base<double> moved = base_of(x, e);
      for (int i = 0; i < kEngineStates; ++i) {
        point(i) = Dual(x(first + i), i);
      }
      for (int i = 0; i < 6; ++i) {
        base(i) = Dual(moved(i), kEngineStates + i);
      }
      EngineVector<Dual> rate;
      Push<Dual> push;
      engine(e, point, base, rate, push);
      Eigen::Matrix<double, kEngineStates, 6> by_base;
      Eigen::Matrix<double, 4, kEngineStates> push_by_state;
      Eigen::Matrix<double, 4, 6> push_by_base;
      for (int i = 0; i < kEngineStates; ++i) {
        all.row(first + i).template segment<kEngineStates>(first) = rate(i).v.template head<kEngineStates>().transpose();
        by_base.row(i) = rate(i).v.template tail<6>().transpose();
      }
      for (int i = 0; i < 4; ++i) {
        push_by_state.row(i) = push(i).v.template head<kEngineStates>().transpose();
        push_by_base.row(i) = push(i).v.template tail<6>().transpose();
      }
      for (int k = 0; k < Modes; ++k) {
        const Push<double> own = shape(k, e);
        all.row(kModes + 2 * k + 1).template segment<kEngineStates>(first) += own.transpose() * push_by_state;
        const Eigen::Matrix<double, 4, 1> at = own;
        all.col(kModes + 2 * k).template segment<kEngineStates>(first) += by_base.template leftCols<4>() * at;
        all.col(kModes + 2 * k + 1).template segment<kEngineStates>(first) +=
            by_base.template rightCols<2>() * at.template tail<2>();
        for (int i = 0; i < Modes; ++i) {
          const Eigen::RowVector<double, 6> of = shape(i, e).transpose() * push_by_base;
          all(kModes + 2 * i + 1, kModes + 2 * k) += of.template head<4>().dot(at);
          all(kModes + 2 * i + 1, kModes + 2 * k + 1) += of.template tail<2>().dot(at.template tail<2>());
        }
      }
    }
  }

 private:
  double frequency(int k) const noexcept {
    return 2.0 * std::numbers::pi * vehicle->modes[static_cast<std::size_t>(k)].frequency;
  }
  Push<double> shape(int k, int e) const noexcept {
    const auto& mode = vehicle->modes[static_cast<std::size_t>(k)];
    const auto at = static_cast<std::size_t>(2 * e);
    return {mode.attach[at], mode.attach[at + 1], mode.rotation[at], mode.rotation[at + 1]};
  }
  void mode_rates(const Vector<double>& x, int k, Vector<double>& rate) const noexcept {
    const double w = frequency(k);
    const double damping = vehicle->modes[static_cast<std::size_t>(k)].damping;
    rate(kModes + 2 * k) = x(kModes + 2 * k + 1);
    rate(kModes + 2 * k + 1) = -2.0 * damping * w * x(kModes + 2 * k + 1) - w * w * x(kModes + 2 * k);
  }
  Base<double> base_of(const Vector<double>& x, int e) const noexcept {
    Base<double> base = Base<double>::Zero();
    for (int k = 0; k < Modes; ++k) {
      const Push<double> own = shape(k, e);
      base.template head<4>() += x(kModes + 2 * k) * own;
      base.template tail<2>() += x(kModes + 2 * k + 1) * own.template tail<2>();
    }
    return base;
  }

  template <class S>
  static S dot(const Three<S>& a, const Three<S>& b) noexcept {
    return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
  }

  /// The force of a load spring with the law `compliance`, solved from that of the last evaluation.
  template <class S>
  S spring_force(int e, int axis, const S& deflection) const noexcept {
    const ReferenceAxis& own = vehicle->engines[static_cast<std::size_t>(e)].axes[static_cast<std::size_t>(axis)];
    const double stiffness = 1.0 / (1.0 / own.actuator_stiffness + 1.0 / own.load_stiffness);
    double& near = spring_guess[static_cast<std::size_t>(2 * e + axis)];
    model::SoftStiffness::Params<S> law;
    law.low_stiffness = S{own.low_stiffness};
    law.load_scale = S{own.load_scale};
    model::SoftStiffness::State<S> guess{near};
    const model::Spring<S> spring{deflection,           S{0.0}, S{1.0}, S{1.0}, S{stiffness}, S{own.actuator_stiffness},
                                  S{own.load_stiffness}};
    const S force = stiffness * model::SoftStiffness::step(law, guess, spring).deflection;
    near = guess.magnitude;
    return force;
  }

  /// Friction of the bearing and its own rate, which depend on each other: the torque turns the bearing, whose rate is part
  /// of the slip. The bristle's damping is a fifth of the bearing's at most, so that each repetition gains a digit.
  template <class S>
  void bearing(const ReferenceVehicle::Engine& own, const Three<S>& force, const Two<S>& engine_rate,
               const EngineVector<S>& x, EngineVector<S>& rate, Two<S>& torque) const noexcept {
    using std::sqrt;
    constexpr int kRepetitions = 6;
    const auto& law = own.friction;
    const S load = sqrt(dot<S>(force, force));
    const S sliding = law.level + law.coefficient * law.radius * load;
    Eigen::Matrix<S, 6, 1> moved;
    for (int i = 0; i < 6; ++i) {
      moved(i) = own.bearing_compliance(i, 0) * force(0) + own.bearing_compliance(i, 1) * force(1) +
                 own.bearing_compliance(i, 2) * force(2) - x(kBearing + i);
    }
    torque = law.stiffness * Two<S>(x(kBristle), x(kBristle + 1));
    Two<S> bristle_rate;
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      for (int i = 0; i < 6; ++i) {
        rate(kBearing + i) =
            (moved(i) + own.bearing_compliance(i, 4) * torque(0) + own.bearing_compliance(i, 5) * torque(1)) / own.loss_time;
      }
      const Two<S> slip(engine_rate(0) - rate(kBearing + 4), engine_rate(1) - rate(kBearing + 5));
      const S squared = slip(0) * slip(0) + slip(1) * slip(1);
      const S speed = model::value_of(squared) > 0.0 ? S(sqrt(squared)) : S{0.0};
      const S vibrated = model::vibrated_level<S>(speed, sliding, S{law.vibration_ratio}, S{law.vibration_velocity});
      const S level = model::stribeck_level<S>(speed, vibrated, S{law.static_ratio}, S{law.stribeck});
      const S damping = model::passive_damping<S>(S{law.damping}, S(sliding * law.vibration_ratio), speed);
      for (int i = 0; i < 2; ++i) {
        bristle_rate(i) = slip(i) - law.stiffness * speed / level * x(kBristle + i);
        torque(i) = law.stiffness * x(kBristle + i) + damping * bristle_rate(i) + law.viscous * slip(i);
      }
    }
    rate(kBristle) = bristle_rate(0);
    rate(kBristle + 1) = bristle_rate(1);
  }

  template <class S>
  void engine(int e, const EngineVector<S>& x, const Base<S>& base, EngineVector<S>& rate, Push<S>& push) const noexcept {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const ReferenceVehicle::Engine& own = vehicle->engines[static_cast<std::size_t>(e)];
    const S sp = sin(x(kAngle));
    const S cp = cos(x(kAngle));
    const S sy = sin(x(kAxisStates + kAngle));
    const S cy = cos(x(kAxisStates + kAngle));
    // First by yaw about the engine's z, then with it by pitch about the vehicle's y.
    const auto turned = [&](const Eigen::Vector3d& at) {
      const S along = cy * at(0) - sy * at(1);
      const S across = sy * at(0) + cy * at(1);
      return Three<S>(cp * along + sp * at(2), across, cp * at(2) - sp * along);
    };
    const Three<S> yaw_axis(sp, S{0.0}, cp);
    const double thrust = own.thrust + own.dead_load;
    Three<S> force = thrust * turned(Eigen::Vector3d::UnitX());
    Two<S> torque(S{-own.thrust * own.misalignment(0)}, S{-own.thrust * own.misalignment(1)});
    for (int axis = 0; axis < 2; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const Three<S> at = turned(own.on_engine[i]);
      const Three<S> line = at - own.on_vehicle[i].template cast<S>();
      const S length = sqrt(dot<S>(line, line));
      const Three<S> direction = line / length;
      const S stroke = length - (own.on_engine[i] - own.on_vehicle[i]).norm();
      const S motion = direction(0) * x(kBearing) + direction(1) * x(kBearing + 1) + direction(2) * x(kBearing + 2);
      const S spring = spring_force<S>(e, axis, x(axis * kAxisStates + kPiston) - stroke - base(axis) - motion);
      push(axis) = spring;
      force += spring * direction;
      torque(0) += spring * (direction(0) * at(2) - direction(2) * at(0));
      torque(1) += spring * dot<S>(direction, Three<S>(yaw_axis(1) * at(2) - yaw_axis(2) * at(1),
                                                       yaw_axis(2) * at(0) - yaw_axis(0) * at(2),
                                                       yaw_axis(0) * at(1) - yaw_axis(1) * at(0)));
    }
    Two<S> friction;
    bearing<S>(own, force, Two<S>(x(kAngleRate) - base(4), x(kAxisStates + kAngleRate) - base(5)), x, rate, friction);
    for (int axis = 0; axis < 2; ++axis) {
      hydraulics<S>(own.axes[static_cast<std::size_t>(axis)], commands[static_cast<std::size_t>(2 * e + axis)],
                    axis * kAxisStates, x, push(axis), rate);
      const ReferenceAxis& a = own.axes[static_cast<std::size_t>(axis)];
      const int first = axis * kAxisStates;
      const S& angle = x(first + kAngle);
      const S& angle_rate = x(first + kAngleRate);
      push(2 + axis) =
          friction(axis) + a.duct_stiffness * (angle - base(2 + axis)) + a.damping * (angle_rate - base(4 + axis));
      rate(first + kAngle) = angle_rate;
      rate(first + kAngleRate) = (torque(axis) - push(2 + axis)) / a.inertia;
    }
  }

  template <class S>
  static void hydraulics(const ReferenceAxis& a, double command, int first, const EngineVector<S>& x, const S& force,
                         EngineVector<S>& rate) noexcept {
    using std::sqrt;
    const auto at = [&](int i) -> const S& { return x(first + i); };
    const S asked = model::clamp_symmetric<S>(
        a.position_gain * (a.arm * command - at(kPiston)) - a.pressure_gain * (at(kPressure) - at(kWashout)), S{1.0});
    rate(first + kSpool) = at(kSpoolRate);
    rate(first + kSpoolRate) = a.valve_frequency * a.valve_frequency * (asked - at(kSpool)) -
                               2.0 * a.valve_damping * a.valve_frequency * at(kSpoolRate);
    const S opening = at(kSpool) - model::clamp_symmetric<S>(at(kSpool), S{a.deadband});
    const S drop = 1.0 - model::sign_of(opening) * at(kPressure) / a.supply;
    const S flow = a.rated_flow * opening * sqrt(model::value_of(drop) > 1e-9 ? drop : S{1e-9});
    rate(first + kPressure) =
        4.0 * a.bulk_modulus / a.volume * (flow - a.area * at(kPistonRate) - a.leakage * at(kPressure));
    rate(first + kWashout) = a.pressure_corner * (at(kPressure) - at(kWashout));
    rate(first + kPiston) = at(kPistonRate);
    rate(first + kPistonRate) = (a.area * at(kPressure) - force - a.piston_damping * at(kPistonRate)) / a.piston_mass;
  }
};

}  // namespace hotfire::test
