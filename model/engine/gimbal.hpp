// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "model/engine/geometry.hpp"
#include "model/friction/vector_friction.hpp"
#include "model/numerics/linear_algebra.hpp"

namespace hotfire::model {

/// What the friction of a bearing depends on beyond its slip, over one step.
template <class S>
struct BearingCondition {
  S load{0.0};       ///< N, size of the force through the bearing [N]
  S vibration{1.0};  ///< size of the vibration over the declared one [-]
};

/// The friction of a ball joint, over both directions of its slip, by one of four laws: `coulomb` (rigid), `dahl` (bristle,
/// one level, z' = |v| w |w|^(exponent - 1) with w = v/|v| - sigma0 z / level: [GF] slide Dahl, [Dahl 1976]), `lugre`
/// (bristle, Stribeck level, bristle damping), `vibrated_lugre` (its level lowered by vibration at low speed, [GF] slide
/// Vibration: ratio gamma2, velocity v_s). The level is `coulomb_torque` + mu N r with the force N through the bearing
/// [physics.md section 3]. `viscous` is sigma2 of the slip; the engine's own `viscous_damping` works on its angle. Bristle
/// damping dies with speed, so that the law is passive for any values (`passive_damping`).
template <class S>
struct BearingFriction {
  using Scalar = S;
  static constexpr std::string_view name = "friction";
  static constexpr std::string_view option_key = "law";
  enum class Law { coulomb, dahl, lugre, vibrated_lugre };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 4> options{"coulomb", "dahl", "lugre", "vibrated_lugre"};
  int option = static_cast<int>(Law::lugre);
  S coulomb_torque{0.0};
  S stiffness{1e7};
  S static_ratio{1.0};
  S stribeck_velocity{0.01};
  S damping{0.0};
  S vibration_ratio{1.0};
  S vibration_velocity{0.01};
  S coefficient{0.0};
  S radius{0.13};
  S viscous{0.0};
  S exponent{1.0};
  static constexpr auto fields() {
    using P = BearingFriction;
    constexpr unsigned kBristle = only(Law::dahl, Law::lugre, Law::vibrated_lugre);
    constexpr unsigned kLugre = only(Law::lugre, Law::vibrated_lugre);
    constexpr unsigned kVibrated = only(Law::vibrated_lugre);
    return std::array{
        Field<P>{"coulomb_torque", "N.m", 0.0, 1e7, 8e3, "friction torque of steady sliding, whatever the load",
                 &P::coulomb_torque},
        Field<P>{"stiffness", "N.m/rad", 1e4, 1e11, 1e7, "bristle stiffness sigma0, before sliding", &P::stiffness,
                 kBristle},
        Field<P>{"static_ratio", "1", 1.0, 5.0, 1.2, "break-away torque over sliding torque", &P::static_ratio, kLugre},
        Field<P>{"stribeck_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which static friction dies out",
                 &P::stribeck_velocity, kLugre},
        Field<P>{"damping", "N.m.s/rad", 0.0, 1e8, 1e3, "bristle damping sigma1", &P::damping, kLugre},
        Field<P>{"vibration_ratio", "1", 0.0, 1.0, 0.5, "friction left at rest under vibration", &P::vibration_ratio,
                 kVibrated},
        Field<P>{"vibration_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which the loss to vibration dies out",
                 &P::vibration_velocity, kVibrated},
        Field<P>{"coefficient", "1", 0.0, 1.0, 0.08, "friction coefficient mu of the bearing's ball", &P::coefficient},
        Field<P>{"radius", "m", 1e-3, 10.0, 0.13, "radius r of the bearing's ball", &P::radius},
        Field<P>{"viscous", "N.m.s/rad", 0.0, 1e8, 1e3, "viscous friction sigma2 of the slip", &P::viscous, kBristle},
        Field<P>{"exponent", "1", 1.0, 4.0, 1.0, "Dahl's exponent: how late a bristle yields", &P::exponent,
                 only(Law::dahl)}};
  }
  Law law() const noexcept { return static_cast<Law>(option); }
  void choose(Law own) noexcept { option = static_cast<int>(own); }

  /// True if the bearing rubs under some load.
  bool rubs() const noexcept { return value_of(coulomb_torque) > 0.0 || value_of(coefficient) > 0.0; }

  /// Friction torque of steady sliding, without vibration, under a force through the bearing [N m].
  S sliding_torque(const S& load) const noexcept { return coulomb_torque + coefficient * radius * load; }

  /// Mean torque against the slip over one step; advances the deflection of the bristle. A bearing without any friction
  /// forgets it.
  ///
  /// A bristle's step needs the speed of the slip, which its torque changes: on a compliant bearing by far the most of it.
  /// Both are found together by two steps of substitution, Aitken's extrapolation of the three speeds, and a last step from
  /// there.
  Pair<S> torque(Pair<S>& deflection, const Slip<S>& slip, const BearingCondition<S>& condition = {}) const noexcept {
    const S sliding = sliding_torque(condition.load);
    if (law() == Law::coulomb) {
      return model::coulomb_torque<S>(slip, sliding);
    }
    // A level of zero is no friction: the bristle is not divided by it.
    const auto rubbing = value_of(sliding) > 0.0;
    if (!anywhere(rubbing)) {
      deflection = {};
      return {};
    }
    const S left = 1.0 - (1.0 - vibration_ratio) * condition.vibration;
    const S guess = slip.velocity.length();
    // With its power held, Dahl's bristle is one whose deflection is divided, and whose stiffness is multiplied by it.
    const S power = law() == Law::dahl ? yielding(deflection, slip.velocity, guess, sliding) : S{1.0};
    const Pair<S> start = S(1.0 / power) * deflection;
    const Bristle<S> bristle{stiffness * power, law() == Law::dahl ? S{0.0} : damping_at(guess, sliding, left), viscous};
    Pair<S> end;
    const auto torque_at = [&](const S& speed) {
      end = start;
      return bristle_torque<S>(end, slip, speed, level_at(speed, sliding, left), bristle);
    };
    const auto speed_under = [&](const Pair<S>& torque) {
      return (slip.free_velocity - slip.compliance.times(torque)).length();
    };
    const S first = speed_under(torque_at(guess));
    const S second = speed_under(torque_at(first));
    const Pair<S> torque = torque_at(extrapolated_speed<S>(guess, first, second));
    deflection = select(rubbing, power * end, Pair<S>{});
    return select(rubbing, torque, Pair<S>{});
  }

 private:
  S level_at(const S& speed, const S& sliding, const S& left) const noexcept {
    if (law() == Law::dahl) {
      return sliding;
    }
    if (law() == Law::lugre) {
      return stribeck_level<S>(speed, sliding, static_ratio, stribeck_velocity);
    }
    return vibrated_stribeck_level<S>(speed, sliding, static_ratio, stribeck_velocity, left, vibration_velocity);
  }

  /// The bound of passivity holds for the least level that the law reaches.
  S damping_at(const S& speed, const S& sliding, const S& left) const noexcept {
    const S least = law() == Law::vibrated_lugre ? sliding * left : sliding;
    return select(value_of(least) > 0.0, passive_damping<S>(damping, least, speed), S{0.0});
  }

  /// Dahl's |w|^(exponent - 1) at the start of the step.
  S yielding(const Pair<S>& deflection, const Pair<S>& velocity, const S& speed, const S& sliding) const noexcept {
    using std::pow;
    const auto has_power = value_of(exponent) > 1.0;
    const auto slips = value_of(speed) > 0.0;
    if (!anywhere(has_power) || !anywhere(slips)) {
      return S{1.0};
    }
    const S w = (S(1.0 / speed) * velocity - S(stiffness / sliding) * deflection).length();
    constexpr double kLeast = 1e-3;  // of the level: a bristle this close to it slides, and is not divided by zero
    const S power = pow(select(value_of(w) > kLeast, w, S{kLeast}), S(exponent - 1.0));
    return select(has_power, select(slips, power, S{1.0}), S{1.0});
  }
};

/// Vibration of the bearing as slip velocity, simulated: its mean over each step, so a step must be short against its
/// period. A sine amplitude sin(2 pi frequency t) about both angles. The law `vibrated_lugre` is the same physics, averaged:
/// a gimbal has one of the two.
template <class S>
struct BearingVibration {
  using Scalar = S;
  static constexpr std::string_view name = "vibration";
  S pitch_velocity{0.0};
  S yaw_velocity{0.0};
  S frequency{100.0};
  static constexpr auto fields() {
    using P = BearingVibration;
    return std::array{
        Field<P>{"pitch_velocity", "rad/s", 0.0, 10.0, 0.01, "amplitude of the slip velocity about pitch",
                 &P::pitch_velocity},
        Field<P>{"yaw_velocity", "rad/s", 0.0, 10.0, 0.01, "amplitude of the slip velocity about yaw", &P::yaw_velocity},
        Field<P>{"frequency", "Hz", 1.0, 2e4, 100.0, "frequency of the vibration", &P::frequency}};
  }
  bool vibrates() const noexcept {
    return anywhere(value_of(pitch_velocity) > 0.0) || anywhere(value_of(yaw_velocity) > 0.0);
  }
};

/// The bearing between an engine and its mount: what loads it, and its compliance in translation and torsion.
///
/// The force through it is thrust, dead load, the push of both actuators and whatever disturbs it. A bearing whose parts
/// seat under load is softer without: its translation under a force F is
///   u = C F (1 + (1 / unloaded_stiffness - 1) e^{-(N / load_scale)^2}),   N^2 = F^T C F / C_xx,
/// C being the compliance of `stiffness`, which is that under full load. N is the size of F for a C that is the same in all
/// directions, and makes u the gradient of an energy for any. [SD 2, 3]: "load-dependent stiffnesses in the actuator and
/// gimbal"; the law is our choice, smooth at zero load.
template <class S>
struct GimbalBearing {
  using Scalar = S;
  static constexpr std::string_view name = "gimbal";
  S thrust{0.0};
  S loss_time{1e-3};
  S dead_load{0.0};
  S rated_thrust{0.0};
  S unloaded_stiffness{1.0};
  S load_scale{1e5};
  S unloaded_structure{1.0};
  S pitch_misalignment{0.0};
  S yaw_misalignment{0.0};
  S block_mass{0.0};
  S block_inertia{0.0};
  S vehicle_side_flexibility{0.5};
  static constexpr auto fields() {
    using P = GimbalBearing;
    return std::array{
        Field<P>{"thrust", "N", 0.0, 1e8, 1.86e6, "thrust through the gimbal", &P::thrust},
        Field<P>{"loss_time", "s", 1e-5, 1.0, 1e-3, "structural damping of the bearing over its stiffness", &P::loss_time},
        Field<P>{"dead_load", "N", -1e8, 1e8, 4e4, "force of weight and ducts on the bearing, along the thrust",
                 &P::dead_load},
        Field<P>{"rated_thrust", "N", 0.0, 1e8, 1.86e6,
                 "thrust at which vibration and structure are as declared; 0: they are so at any thrust", &P::rated_thrust},
        Field<P>{"unloaded_stiffness", "1", 1e-3, 1.0, 0.1, "translational stiffness without load, over that under load",
                 &P::unloaded_stiffness},
        Field<P>{"load_scale", "N", 10.0, 1e8, 1e5, "load over which the translational stiffness rises", &P::load_scale},
        Field<P>{"unloaded_structure", "1", 1e-2, 1.0, 0.5,
                 "structure.stiffness of both attach points without thrust, over that under rated thrust",
                 &P::unloaded_structure},
        Field<P>{"pitch_misalignment", "m", -1.0, 1.0, 3e-3, "arm of the thrust against positive pitch",
                 &P::pitch_misalignment},
        Field<P>{"yaw_misalignment", "m", -1.0, 1.0, 3e-3, "arm of the thrust against positive yaw", &P::yaw_misalignment},
        Field<P>{"block_mass", "kg", 0.0, 1e5, 50.0, "mass of the block between the halves of the bearing; 0: no block",
                 &P::block_mass},
        Field<P>{"block_inertia", "kg.m^2", 0.0, 1e5, 1.0, "inertia of the block about pitch and about yaw; 0: no block",
                 &P::block_inertia},
        Field<P>{"vehicle_side_flexibility", "1", 0.01, 0.99, 0.5,
                 "flexibility between vehicle and block over that of the whole bearing", &P::vehicle_side_flexibility}};
  }

  /// Size of the vibration under a thrust, over the declared one.
  S vibration_under(const S& own_thrust) const noexcept {
    return select(value_of(rated_thrust) > 0.0, S(own_thrust / rated_thrust), S{1.0});
  }

  /// What a thrust below the rated one adds to the flexibility of an attach point, over what the declared stiffness gives:
  /// from nothing at rated thrust, linearly to that of `unloaded_structure` without. Thrust comes with full and pressurised
  /// tanks, which stiffen what the actuators push against [SD 2.4]: one switch for both.
  S further_structure(const S& own_thrust) const noexcept {
    const S missing = select(value_of(rated_thrust) > value_of(own_thrust), S(1.0 - own_thrust / rated_thrust), S{0.0});
    return (1.0 / unloaded_structure - 1.0) * missing;
  }
};

/// Everything of one gimbal. A block with mass and inertia moves between the bearing's halves: `bearing_block.hpp`.
/// `stiffness` is the 6x6 matrix of the bearing: forces along x, y, z and moments about them [N,
/// N m] per translation and rotation [m, rad] of its engine's half against the vehicle's; symmetric, positive definite.
template <class S>
struct GimbalParameters {
  GimbalBearing<S> bearing;
  BearingFriction<S> friction;
  BearingVibration<S> vibration;
  bool compliant = false;  ///< without it the bearing is rigid and `stiffness` is not read
  Eigen::Matrix<S, 6, 6> stiffness = Eigen::Matrix<S, 6, 6>::Identity();

  /// True if a block with inertia moves between the halves of the bearing.
  bool has_block() const noexcept { return compliant && anywhere(value_of(bearing.block_mass) > 0.0); }

  template <class Self, class F>
  static void for_each_part(Self& self, F&& f) {
    f(self.bearing);
    f(self.friction);
    f(self.vibration);
  }
};

/// What is wrong with a gimbal; empty if nothing.
template <class S>
std::string_view broken_relation(const GimbalParameters<S>& gimbal) {
  if (gimbal.compliant && !is_symmetric(gimbal.stiffness)) {
    return "the stiffness matrix is not symmetric";
  }
  if (gimbal.compliant && !is_positive_definite(gimbal.stiffness)) {
    return "the stiffness matrix is not positive definite";
  }
  if (value_of(gimbal.bearing.unloaded_structure) < 1.0 && !(value_of(gimbal.bearing.rated_thrust) > 0.0)) {
    return "unloaded_structure has no meaning without rated_thrust; give it";
  }
  const bool has_mass = value_of(gimbal.bearing.block_mass) > 0.0;
  const bool has_inertia = value_of(gimbal.bearing.block_inertia) > 0.0;
  if (has_mass != has_inertia) {
    return "a block has a mass and an inertia; give block_mass and block_inertia, or neither";
  }
  if (has_mass && !gimbal.compliant) {
    return "a block cannot move on a rigid bearing; give gimbal.stiffness, or leave block_mass and block_inertia out";
  }
  constexpr double kLeastBlock = 1e-6;  // kg, kg m^2: a milligram rings beyond 1 MHz on any bearing that carries an engine
  if (has_mass &&
      (value_of(gimbal.bearing.block_mass) < kLeastBlock || value_of(gimbal.bearing.block_inertia) < kLeastBlock)) {
    return "block_mass and block_inertia must be above 1e-6; leave both out for a bearing without a block";
  }
  if (gimbal.vibration.vibrates() && gimbal.friction.law() == BearingFriction<S>::Law::vibrated_lugre) {
    return "the law \"vibrated_lugre\" and a simulated vibration are two ways to the same physics; give one of them";
  }
  return {};
}

/// Mean slip velocity that the simulated vibration adds over step number `tick`.
template <class S>
Pair<S> vibration_over(const BearingVibration<S>& vibration, long long tick, double h) noexcept {
  using std::cos;
  const S angle = vibration.frequency * (2.0 * std::numbers::pi * h);
  const auto start = static_cast<double>(tick);
  const S mean = (cos(angle * start) - cos(angle * (start + 1.0))) / angle;
  return {vibration.pitch_velocity * mean, vibration.yaw_velocity * mean};
}

}  // namespace hotfire::model
