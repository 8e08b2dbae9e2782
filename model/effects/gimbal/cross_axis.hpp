// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Torque on an axis from the motion of its engine about the other axis: torque = stiffness theta + damping theta', theta
/// the other angle. Ducts, hoses and the bearing are anchored off the axes, so a turn about one axis pulls about the other
/// one [physics.md section 4]. Each axis has its own values: a passive coupling has the same stiffness on both, a follower
/// force such as the thrust does not. Against positive motion if positive. Without a second axis the effect is zero.
struct CrossAxis {
  static constexpr std::string_view name = "cross_axis";
  static constexpr Site site = Site::engine_torque;
  static constexpr NoOptions options{};
  static constexpr bool needs_other_axis = true;

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S stiffness{0.0};
    S damping{0.0};
    static constexpr auto fields() {
      using P = Params;
      return std::array{
          Field<P>{"stiffness", "N.m/rad", -1e8, 1e8, 3e5, "torque per angle of the other axis", &P::stiffness},
          Field<P>{"damping", "N.m.s/rad", -1e7, 1e7, 3e3, "torque per rate of the other axis", &P::damping}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    return params.stiffness * input.other_angle + params.damping * input.other_rate;
  }
};

}  // namespace hotfire::model
