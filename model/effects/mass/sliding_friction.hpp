// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/friction/friction.hpp"

namespace hotfire::model {

/// Friction of a guided mass (`at`: `mass_force`), or of a motor and its bearings, counted at the load (`motor`: torque
/// times the ratio of the transmission). It has its own values per direction: Coulomb level and viscous slope forward and
/// backward, by `coulomb` (rigid), `dahl` (bristle) or `lugre` (bristle with Stribeck level and bristle damping). Source of
/// the laws: friction.hpp; per-direction values as in [Janot, Gautier and Brunot 2019] Data Set and Reference Models of
/// EMPS, eq. 6.
template <Site at>
struct FrictionAt {
  static constexpr std::string_view name = at == Site::motor ? "motor_friction" : "sliding_friction";
  static constexpr Site site = at;
  enum class Law { coulomb, dahl, lugre };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 3> options{"coulomb", "dahl", "lugre"};
  static constexpr std::string_view option_key = "law";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S coulomb_forward{0.0};
    S coulomb_backward{0.0};
    S viscous_forward{0.0};
    S viscous_backward{0.0};
    S stiffness{1e6};
    S static_ratio{1.0};
    S stribeck_velocity{0.01};
    S damping{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"coulomb_forward", "force", 0.0, 1e9, 0.2, "friction of steady forward sliding",
                        &Params::coulomb_forward},
          Field<Params>{"coulomb_backward", "force", 0.0, 1e9, 0.2, "friction of steady backward sliding",
                        &Params::coulomb_backward},
          Field<Params>{"viscous_forward", "force.time/position", 0.0, 1e12, 0.1, "viscous slope, forward",
                        &Params::viscous_forward},
          Field<Params>{"viscous_backward", "force.time/position", 0.0, 1e12, 0.1, "viscous slope, backward",
                        &Params::viscous_backward},
          Field<Params>{"stiffness", "force/position", 1e-6, 1e15, 100.0, "bristle stiffness sigma0", &Params::stiffness,
                        only(Law::dahl, Law::lugre)},
          Field<Params>{"static_ratio", "1", 1.0, 5.0, 1.2, "break-away over sliding friction", &Params::static_ratio,
                        only(Law::lugre)},
          Field<Params>{"stribeck_velocity", "position/time", 1e-9, 1e6, 0.05, "speed at which static friction dies out",
                        &Params::stribeck_velocity, only(Law::lugre)},
          Field<Params>{"damping", "force.time/position", 0.0, 1e12, 0.1, "bristle damping sigma1", &Params::damping,
                        only(Law::lugre)}};
    }
  };

  template <class S>
  struct State {
    S deflection{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Motion<S>& input) noexcept {
    // A body at rest takes the direction in which it is about to move.
    const bool forward =
        value_of(input.velocity) > 0.0 || (value_of(input.velocity) == 0.0 && value_of(input.free_velocity) >= 0.0);
    const Law law = law_of<FrictionAt>(params);
    const S& coulomb = forward ? params.coulomb_forward : params.coulomb_backward;
    const S& viscous = forward ? params.viscous_forward : params.viscous_backward;
    if (law == Law::coulomb) {
      return coulomb_with_viscous(input, coulomb, viscous);
    }
    if (!(value_of(coulomb) > 0.0)) {
      return viscous * input.free_velocity / (1.0 + input.compliance * viscous);
    }
    if (law == Law::dahl) {
      return bristle_force<S>(state.deflection, input, coulomb, Bristle<S>{params.stiffness, S{0.0}, viscous});
    }
    const S level = stribeck_level<S>(input.velocity, coulomb, params.static_ratio, params.stribeck_velocity);
    return bristle_force<S>(state.deflection, input, level, Bristle<S>{params.stiffness, params.damping, viscous});
  }

 private:
  /// Rigid Coulomb and viscous friction solved together: the viscous slope only changes how much a force slows the body.
  template <class S>
  static S coulomb_with_viscous(const Motion<S>& input, const S& coulomb, const S& viscous) noexcept {
    const S softened = 1.0 + input.compliance * viscous;
    Motion<S> reduced = input;
    reduced.free_velocity = input.free_velocity / softened;
    reduced.compliance = input.compliance / softened;
    const S dry = coulomb_force<S>(reduced, coulomb);
    return dry + viscous * (reduced.free_velocity - reduced.compliance * dry);
  }
};

using SlidingFriction = FrictionAt<Site::mass_force>;
using MotorFriction = FrictionAt<Site::motor>;

}  // namespace hotfire::model
