#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "model/geometry.hpp"
#include "model/linear_algebra.hpp"
#include "model/vector_friction.hpp"

namespace hotfire::model {

/// The friction of a ball joint, over both directions of its slip, by one of four laws: `coulomb` (rigid), `dahl` (bristle,
/// one level), `lugre` (bristle, Stribeck level, bristle damping), `vibrated_lugre` (its level lowered by vibration at low
/// speed, [GF] slide Vibration: ratio gamma2, velocity v_s). The level is mu N r. The joint's viscous part is the engine's
/// `viscous_damping`. Bristle damping dies with speed, so that the law is passive for any values (`passive_damping`).
template <class S>
struct BearingFriction {
  using Scalar = S;
  static constexpr std::string_view name = "friction";
  static constexpr std::string_view option_key = "law";
  static constexpr std::array<std::string_view, 4> options{"coulomb", "dahl", "lugre", "vibrated_lugre"};
  int option = 2;
  S coulomb_torque{0.0};
  S stiffness{1e7};
  S static_ratio{1.0};
  S stribeck_velocity{0.01};
  S damping{0.0};
  S vibration_ratio{1.0};
  S vibration_velocity{0.01};
  static constexpr auto fields() {
    using P = BearingFriction;
    return std::array{
        Field<P>{"coulomb_torque", "N.m", 0.0, 1e7, 8e3, "friction torque of steady sliding", &P::coulomb_torque},
        Field<P>{"stiffness", "N.m/rad", 1e4, 1e11, 1e7, "bristle stiffness sigma0, before sliding", &P::stiffness, 0b1110},
        Field<P>{"static_ratio", "1", 1.0, 5.0, 1.2, "break-away torque over sliding torque", &P::static_ratio, 0b1100},
        Field<P>{"stribeck_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which static friction dies out",
                 &P::stribeck_velocity, 0b1100},
        Field<P>{"damping", "N.m.s/rad", 0.0, 1e8, 1e3, "bristle damping sigma1", &P::damping, 0b1100},
        Field<P>{"vibration_ratio", "1", 0.0, 1.0, 0.5, "friction left at rest under vibration", &P::vibration_ratio,
                 0b1000},
        Field<P>{"vibration_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which the loss to vibration dies out",
                 &P::vibration_velocity, 0b1000}};
  }
  static constexpr int kVibrated = 3;

  /// Mean torque against the slip over one step; advances the deflection of the bristle.
  ///
  /// A bristle's step needs the speed of the slip, which its torque changes: on a compliant bearing by far the most of it.
  /// Both are found together by two steps of substitution, Aitken's extrapolation of the three speeds, and a last step from
  /// there.
  Pair<S> torque(Pair<S>& deflection, const Slip<S>& slip) const noexcept {
    if (option == 0) {
      return model::coulomb_torque<S>(slip, coulomb_torque);
    }
    // A level of zero is no friction: the bristle is not divided by it.
    if (!(value_of(coulomb_torque) > 0.0)) {
      return {};
    }
    const Pair<S> start = deflection;
    const S guess = slip.velocity.length();
    const Bristle<S> bristle{stiffness, option == 1 ? S{0.0} : damping_at(guess), S{0.0}};
    const auto torque_at = [&](const S& speed) {
      deflection = start;
      return bristle_torque<S>(deflection, slip, speed, level_at(speed), bristle);
    };
    const auto speed_under = [&](const Pair<S>& torque) {
      return (slip.free_velocity - slip.compliance.times(torque)).length();
    };
    const S first = speed_under(torque_at(guess));
    const S second = speed_under(torque_at(first));
    return torque_at(extrapolated_speed<S>(guess, first, second));
  }

 private:
  S level_at(const S& speed) const noexcept {
    if (option == 1) {
      return coulomb_torque;
    }
    if (option == 2) {
      return stribeck_level<S>(speed, coulomb_torque, static_ratio, stribeck_velocity);
    }
    return vibrated_stribeck_level<S>(speed, coulomb_torque, static_ratio, stribeck_velocity, vibration_ratio,
                                      vibration_velocity);
  }

  /// The bound of passivity holds for the least level that the law reaches.
  S damping_at(const S& speed) const noexcept {
    const S least = option == kVibrated ? coulomb_torque * vibration_ratio : coulomb_torque;
    return value_of(least) > 0.0 ? passive_damping<S>(damping, least, speed) : S{0.0};
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
};

/// The bearing between an engine and its mount: thrust that loads it, compliance in translation and torsion.
template <class S>
struct GimbalBearing {
  using Scalar = S;
  static constexpr std::string_view name = "gimbal";
  S thrust{0.0};
  S loss_time{1e-3};
  static constexpr auto fields() {
    using P = GimbalBearing;
    return std::array{
        Field<P>{"thrust", "N", 0.0, 1e8, 1.86e6, "thrust through the gimbal's centre", &P::thrust},
        Field<P>{"loss_time", "s", 1e-5, 1.0, 1e-3, "structural damping of the bearing over its stiffness", &P::loss_time}};
  }
};

/// Everything of one gimbal. `stiffness` is the 6x6 matrix of the bearing: forces along x, y, z and moments about them [N,
/// N m] per translation and rotation [m, rad] of its engine's half against the vehicle's; symmetric, positive definite.
template <class S>
struct GimbalParameters {
  GimbalBearing<S> bearing;
  BearingFriction<S> friction;
  BearingVibration<S> vibration;
  bool compliant = false;  ///< without it the bearing is rigid and `stiffness` is not read
  Eigen::Matrix<S, 6, 6> stiffness = Eigen::Matrix<S, 6, 6>::Identity();

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
  const bool vibrates = value_of(gimbal.vibration.pitch_velocity) > 0.0 || value_of(gimbal.vibration.yaw_velocity) > 0.0;
  if (vibrates && gimbal.friction.option == BearingFriction<S>::kVibrated) {
    return "the law \"vibrated_lugre\" and a simulated vibration are two ways to the same physics; give one of them";
  }
  return {};
}

/// The bearing as a spring with loss: stiffness (q + loss_time q') = wrench, q being translation and rotation of the
/// engine's half. Advanced exactly under the wrench's mean over the step, held: q+ = fade q + (1 - fade) compliance wrench,
/// fade = e^{-h / loss_time}. The wrench is the thrust, the push of both actuators and the friction's torque; the engine's
/// own inertia is carried by the engine's axes.
template <class S>
class GimbalSpring {
 public:
  using Six = Eigen::Matrix<S, 6, 1>;

  GimbalSpring(const GimbalParameters<S>& gimbal, double h) : h_(h), fade_(exp(S(-h) / gimbal.bearing.loss_time)) {
    compliance_ = gimbal.compliant ? inverse_of_positive_definite<S, 6>(gimbal.stiffness) : Eigen::Matrix<S, 6, 6>::Zero();
  }

  /// Displacement at the end of a step under a force and a torque about pitch (y) and yaw (z).
  Six end(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    Six after;
    for (int i = 0; i < 6; ++i) {
      const S at_rest = rest(i, force, torque);
      after(i) = at_rest + fade_ * (start(i) - at_rest);
    }
    return after;
  }

  /// Mean translation over the step.
  Vector3<S> mean_translation(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    const S start_share = S(0.5) * (1.0 + fade_);
    const S rest_share = S(0.5) * (1.0 - fade_);
    return {start_share * start(0) + rest_share * rest(0, force, torque),
            start_share * start(1) + rest_share * rest(1, force, torque),
            start_share * start(2) + rest_share * rest(2, force, torque)};
  }

  /// Mean rate of rotation over the step.
  Pair<S> rotation_rate(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    const S share = (1.0 - fade_) / h_;
    return {share * (rest(4, force, torque) - start(4)), share * (rest(5, force, torque) - start(5))};
  }

  /// Where a force and a torque would bring the bearing to rest. Set-up only.
  Six settled(const Vector3<S>& force, const Pair<S>& torque) const {
    Six all;
    for (int i = 0; i < 6; ++i) {
      all(i) = rest(i, force, torque);
    }
    return all;
  }

  /// Mean displacement along one direction per mean force along another.
  S mean_flexibility(const Vector3<S>& along, const Vector3<S>& force) const noexcept {
    return dot<S>(along, mean_translation(Six::Zero(), force, {}));
  }

  /// Mean rate of rotation per mean torque.
  SymmetricPair<S> rate_flexibility() const noexcept {
    const S share = (1.0 - fade_) / h_;
    return {share * compliance_(4, 4), share * compliance_(5, 5), share * compliance_(4, 5)};
  }

 private:
  S rest(int i, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    return compliance_(i, 0) * force(0) + compliance_(i, 1) * force(1) + compliance_(i, 2) * force(2) +
           compliance_(i, 4) * torque.pitch + compliance_(i, 5) * torque.yaw;
  }

  double h_;
  S fade_;
  Eigen::Matrix<S, 6, 6> compliance_;
};

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
