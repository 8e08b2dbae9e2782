// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/friction/friction.hpp"

namespace hotfire::model {

/// Friction of the piston's seals at the Stribeck level g = coulomb_force (1 + (static_ratio - 1) e^{-(v /
/// stribeck_velocity)^2}), by one of two laws:
/// - `elastoplastic`: an elastic seal that slips at g (stick, hysteresis before sliding);
/// - `lugre`: a bristle that slides at g without a sharp limit (LuGre without bristle damping).
///
/// The piston is light, so force and velocity are solved together: stable at any step.
/// [Iwan 1966] A Distributed-Element Model for Hysteresis, J. Appl. Mech. 33; laws and Stribeck term in friction.hpp.
struct PistonFriction {
  static constexpr std::string_view name = "piston_friction";
  static constexpr Site site = Site::piston;
  enum class Law { elastoplastic, lugre };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"elastoplastic", "lugre"};
  static constexpr std::string_view option_key = "law";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S coulomb_force{0.0};
    S static_ratio{1.0};
    S stribeck_velocity{0.01};
    S stiffness{1e9};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"coulomb_force", "N", 0.0, 1e6, 5e3, "friction of the sliding seal", &Params::coulomb_force},
          Field<Params>{"static_ratio", "1", 1.0, 5.0, 1.2, "break-away force over sliding force", &Params::static_ratio},
          Field<Params>{"stribeck_velocity", "m/s", 1e-5, 1.0, 0.01, "speed at which the seal's static friction dies out",
                        &Params::stribeck_velocity},
          Field<Params>{"stiffness", "N/m", 1e6, 1e11, 5e8, "stiffness of the seal before it slips", &Params::stiffness}};
    }
  };

  template <class S>
  struct State {
    S deflection{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Motion<S>& input) noexcept {
    const S level = stribeck_level<S>(input.velocity, params.coulomb_force, params.static_ratio, params.stribeck_velocity);
    // A level of zero is no friction: the bristle is not divided by it.
    const auto rubs = value_of(level) > 0.0;
    if (law_of<PistonFriction>(params) == Law::elastoplastic || !anywhere(rubs)) {
      return elastoplastic_force<S>(state.deflection, input, level, params.stiffness);
    }
    S elsewhere = state.deflection;
    S force = bristle_force<S>(state.deflection, input, level, Bristle<S>{params.stiffness, S{0.0}, S{0.0}});
    if (everywhere(rubs)) {
      return force;
    }
    const S force_elsewhere = elastoplastic_force<S>(elsewhere, input, level, params.stiffness);
    state.deflection = select(rubs, state.deflection, elsewhere);
    return select(rubs, force, force_elsewhere);
  }
};

}  // namespace hotfire::model
