// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/engine/gimbal.hpp"
#include "tools/explain/data/other_axis.hpp"
#include "tools/simulate/excitation.hpp"

namespace hotfire::explain {

/// A continuous quantity of the vehicle, between the rows of its run.
inline Excitation interpolated(const std::vector<double>& values, int steps) {
  return {values, steps, Excitation::Between::interpolated};
}

/// The friction of an engine's bearing about one axis, beside the given slip about the other: `model::BearingFriction` as
/// declared, under the force through the bearing of the run of the whole vehicle. What the friction itself turns is found
/// with it, by the whole bearing in series (`model::GimbalSpring`). All other rotation of the two sides is given, with what
/// the inertia of a block makes of the friction that the run had.
template <class S>
class BearingInVehicle {
 public:
  /// `steps` plant steps of `h` [s] a row.
  BearingInVehicle(const AxisGeometry& geometry, const RestOfVehicle::Bearing& given, const std::vector<double>& other_angle,
                   int steps, double h)
      : own_(geometry.own),
        given_(given),
        other_angle_(other_angle),
        vibrating_{interpolated(given.vibrating[0], steps), interpolated(given.vibrating[1], steps)},
        load_(interpolated(given.load, steps)),
        vibration_(interpolated(given.vibration, steps)),
        period_(h * steps),
        h_(h),
        fade_(std::exp(-h / given.loss_time)) {
    friction_.option = geometry.friction.option;
    const auto from = model::BearingFriction<double>::fields();
    const auto to = model::BearingFriction<S>::fields();
    for (std::size_t k = 0; k < from.size(); ++k) {
      friction_.*to[k].member = S(geometry.friction.*from[k].member);
    }
  }

  /// Opens step `k` of a row.
  void go_to(std::size_t row, int k) {
    further_slip_ = vibrating_[0](row, k) - rate_of(given_.turned[0], row);
    other_slip_ = rate_of(other_angle_, row) + vibrating_[1](row, k) - rate_of(given_.turned[1], row);
    condition_ = {S(load_(row, k)), S(vibration_(row, k))};
    twist_before_ = twist_;
  }

  /// Advances the friction under the engine's mean rate about the axis [rad/s]. `compliance` is how much a unit of torque
  /// slows it over a step.
  void slide(const S& own_rate, const S& compliance) {
    const double softness = (1.0 - fade_) * given_.flexibility;
    const S twisting = ((fade_ - 1.0) * twist_before_ + softness * torque()) / h_;
    const S own = own_rate + further_slip_ - twisting;
    const S other(other_slip_);
    model::Slip<S> slip;
    slip.h = h_;
    slip.velocity = own_ == 0 ? model::Pair<S>{own, other} : model::Pair<S>{other, own};
    // The slip about the other axis is given: any compliance leaves it as it is.
    const S both = compliance + softness / h_;
    slip.compliance = {both, both, S(0.0)};
    slip.free_velocity = slip.velocity + slip.compliance.times(torque_);
    torque_ = friction_.torque(bristle_, slip, condition_);
    twist_ = fade_ * twist_before_ + softness * torque();
  }

  /// Against the engine about the axis, mean over the step [N m].
  const S& torque() const { return own_ == 0 ? torque_.pitch : torque_.yaw; }

 private:
  /// Mean rate over a row: a bearing breaks away within less than a row, and what it turns there must not be lost.
  double rate_of(const std::vector<double>& angle, std::size_t row) const {
    return row + 1 < angle.size() ? (angle[row + 1] - angle[row]) / period_ : 0.0;
  }

  std::size_t own_;
  const RestOfVehicle::Bearing& given_;
  const std::vector<double>& other_angle_;
  std::array<Excitation, 2> vibrating_;
  Excitation load_;
  Excitation vibration_;
  double period_;
  double h_;
  double fade_;
  model::BearingFriction<S> friction_;
  double further_slip_ = 0.0;
  double other_slip_ = 0.0;
  model::BearingCondition<S> condition_;
  model::Pair<S> bristle_;
  model::Pair<S> torque_;
  S twist_{0.0};  ///< what the friction turns the bearing [rad]
  S twist_before_{0.0};
};

}  // namespace hotfire::explain
