// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/effects/gimbal/gimbal_friction.hpp"

namespace hotfire::model {

/// Torsional spring in series with the friction of the gimbal ([GF]: gimbal structural compliance): the bearing slips
/// at u = beta' - T' / stiffness instead of beta'. Carries `gimbal_friction`, whose law and values are its own.
///
/// T' over the step is the second-order backward difference of the mean torques (BDF2, damped at any step). The speed of the
/// slip, which a bristle's step needs, is mostly the spring's doing: it is found together with the torque by two steps of
/// substitution and Aitken's extrapolation.
struct GimbalCompliance {
  static constexpr std::string_view name = "gimbal_compliance";
  static constexpr std::string_view carries = GimbalFriction::name;
  static constexpr Site site = Site::engine_torque;
  static constexpr NoOptions options{};
  static constexpr double kRigid = 1e12;

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S stiffness{kRigid};
    static constexpr auto fields() {
      return std::array{Field<Params>{"stiffness", "N.m/rad", 1e4, kRigid, 1e7,
                                      "torsional spring between engine and friction", &Params::stiffness}};
    }
  };

  template <class S>
  struct State {
    S last{0.0};         ///< mean torque of the last step [N m]
    S before_last{0.0};  ///< and of the one before
    S speed{0.0};        ///< of the slip in the last step [rad/s]
  };

  /// Nothing of its own.
  template <class S>
  static S step(const Params<S>&, State<S>&, const Motion<S>&) noexcept {
    return S{0.0};
  }

  /// The mean torque of the friction behind the spring; `step` evaluates the friction from where the step starts.
  template <class S, class Step>
  static S carry(const Params<S>& params, State<S>& state, const Motion<S>& input, Step&& step) noexcept {
    const S give = 1.0 / (params.stiffness * input.h);
    Motion<S> slip = input;
    slip.free_velocity = input.free_velocity + give * (2.0 * state.last - 0.5 * state.before_last);
    slip.compliance = input.compliance + 1.5 * give;
    const auto torque_at = [&](const S& speed) {
      slip.velocity = speed;
      return step(slip);
    };
    const auto speed_under = [&](const S& torque) {
      const S velocity = slip.free_velocity - slip.compliance * torque;
      return S(velocity * sign_of(velocity));
    };
    // The last step's speed: one far above the solution would put the substitution on the wrong side of a reversal.
    const S first = speed_under(torque_at(state.speed));
    const S second = speed_under(torque_at(first));
    S torque = torque_at(extrapolated_speed<S>(state.speed, first, second));
    state.speed = speed_under(torque);
    state.before_last = state.last;
    state.last = torque;
    return torque;
  }
};

}  // namespace hotfire::model
