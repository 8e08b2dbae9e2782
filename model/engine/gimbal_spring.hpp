// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "model/engine/geometry.hpp"
#include "model/engine/gimbal.hpp"
#include "model/friction/vector_friction.hpp"
#include "model/numerics/linear_algebra.hpp"

namespace hotfire::model {

/// A bearing, or its engine's half beside a block, as a spring with loss: stiffness (q + loss_time q') = wrench, q being
/// translation and rotation of the engine against the block or, without one, against the vehicle. Advanced exactly under the
/// wrench's mean over the step, held: q+ = fade q + (1 - fade) compliance wrench, fade = e^{-h / loss_time}. The wrench is
/// the force through the bearing and the friction's torque; the engine's own inertia is carried by the engine's axes.
/// `softness` is the translational compliance over that under full load (`GimbalBearing`). The joint itself is what seats
/// under load. With a block the additional flexibility without load is therefore on the engine's side.
template <class S>
class GimbalSpring {
 public:
  using Six = Eigen::Matrix<S, 6, 1>;

  GimbalSpring(const GimbalParameters<S>& gimbal, double h)
      : h_(h),
        fade_(exp(S(-h) / gimbal.bearing.loss_time)),
        load_scale_(gimbal.bearing.load_scale),
        further_(1.0 / gimbal.bearing.unloaded_stiffness - 1.0) {
    compliance_ = gimbal.compliant ? inverse_of_positive_definite<S, 6>(gimbal.stiffness) : Eigen::Matrix<S, 6, 6>::Zero();
    if (gimbal.has_block()) {
      const S share = 1.0 - gimbal.bearing.vehicle_side_flexibility;
      compliance_ *= share;
      further_ /= share;
    }
    seats_ = gimbal.compliant && anywhere(value_of(further_) > 0.0);
    turning_ << compliance_.template block<2, 3>(4, 0), compliance_.template block<2, 2>(4, 4);
  }

  /// Adds what else turns with the spring: mean rate of its rotation about pitch and yaw per mean force along x, y, z and
  /// mean torque about pitch and yaw.
  void add_rate_flexibility(const Eigen::Matrix<S, 2, 5>& more) noexcept { turning_ += more * (h_ / (1.0 - fade_)); }

  /// Translational compliance under a force, over that under full load.
  S softness(const Vector3<S>& force) const noexcept {
    if (!seats_) {
      return S{1.0};
    }
    Vector3<S> moved;
    for (int i = 0; i < 3; ++i) {
      moved(i) = compliance_(i, 0) * force(0) + compliance_(i, 1) * force(1) + compliance_(i, 2) * force(2);
    }
    const S load = dot<S>(force, moved) / (compliance_(0, 0) * load_scale_ * load_scale_);
    return select(value_of(further_) > 0.0, S(1.0 + further_ * fading_exponential<S>(load)), S{1.0});
  }

  /// Displacement at the end of a step under a force and a torque about pitch (y) and yaw (z).
  Six end(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    const S soft = softness(force);
    Six after;
    for (int i = 0; i < 6; ++i) {
      const S at_rest = i < 3 ? translation(i, soft, force, torque) : rest(i, force, torque);
      after(i) = at_rest + fade_ * (start(i) - at_rest);
    }
    return after;
  }

  /// Mean translation over the step.
  Vector3<S> mean_translation(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    const S start_share = S(0.5) * (1.0 + fade_);
    const S rest_share = S(0.5) * (1.0 - fade_);
    const S soft = softness(force);
    return {start_share * start(0) + rest_share * translation(0, soft, force, torque),
            start_share * start(1) + rest_share * translation(1, soft, force, torque),
            start_share * start(2) + rest_share * translation(2, soft, force, torque)};
  }

  /// Mean rate of rotation over the step.
  Pair<S> rotation_rate(const Six& start, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    const S share = (1.0 - fade_) / h_;
    return {share * (turned(0, force, torque) - start(4)), share * (turned(1, force, torque) - start(5))};
  }

  /// Where a force and a torque would bring the bearing to rest. Set-up only.
  Six settled(const Vector3<S>& force, const Pair<S>& torque) const {
    const S soft = softness(force);
    Six all;
    for (int i = 0; i < 6; ++i) {
      all(i) = i < 3 ? translation(i, soft, force, torque) : rest(i, force, torque);
    }
    return all;
  }

  /// Mean displacement along one direction per mean force along another, under a load.
  S mean_flexibility(const Vector3<S>& along, const Vector3<S>& force, const Vector3<S>& load) const noexcept {
    const S share = S(0.5) * (1.0 - fade_) * softness(load);
    Vector3<S> moved;
    for (int i = 0; i < 3; ++i) {
      moved(i) = share * (compliance_(i, 0) * force(0) + compliance_(i, 1) * force(1) + compliance_(i, 2) * force(2));
    }
    return dot<S>(along, moved);
  }

  /// Mean rate of rotation per mean torque.
  SymmetricPair<S> rate_flexibility() const noexcept {
    const S share = (1.0 - fade_) / h_;
    return {share * turning_(0, 3), share * turning_(1, 4), share * turning_(0, 4)};
  }

 private:
  S rest(int i, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    return translation(i, S(1.0), force, torque);
  }
  S turned(int i, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    return (turning_(i, 0) * force(0) + turning_(i, 1) * force(1) + turning_(i, 2) * force(2)) +
           turning_(i, 3) * torque.pitch + turning_(i, 4) * torque.yaw;
  }
  S translation(int i, const S& soft, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    return soft * (compliance_(i, 0) * force(0) + compliance_(i, 1) * force(1) + compliance_(i, 2) * force(2)) +
           compliance_(i, 4) * torque.pitch + compliance_(i, 5) * torque.yaw;
  }

  double h_;
  S fade_;
  S load_scale_;
  S further_;
  bool seats_ = false;
  Eigen::Matrix<S, 6, 6> compliance_;
  Eigen::Matrix<S, 2, 5> turning_;  ///< its rows of pitch and yaw, and what was added
};

}  // namespace hotfire::model
