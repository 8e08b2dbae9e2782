// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/friction/friction.hpp"

namespace hotfire::model {

/// Friction of the gimbal bearing, by one of five laws: `coulomb` (rigid), `dahl` (bristle, one level), `lugre` (bristle,
/// Stribeck level, bristle damping), `vibrated_lugre` (its level lowered by vibration at low speed, [GF] slide Vibration:
/// ratio gamma2, velocity v_s2), `vector_lugre` (a ball joint's: |v| is the length of the slip about both axes, so that
/// motion about the other axis lowers the friction about this one). The bearing's viscous part is the engine's
/// `viscous_damping`.
///
/// The components of a bristle vector, z' = v - sigma0 |v| z / g, meet through |v| alone. So two axes with `vector_lugre`
/// and the same values are the vector friction of one bearing, each with its own component of the bristle.
///
/// Passivity of LuGre needs viscous > damping (static_ratio - 1); the bristle damping here dies with speed
/// (`passive_damping`), so that the law is passive for any values. Source of the laws: [GF] slides Coulomb, Dahl, LuGre;
/// bristle step in friction.hpp.
struct GimbalFriction {
  static constexpr std::string_view name = "gimbal_friction";
  static constexpr Site site = Site::engine_torque;
  enum class Law { coulomb, dahl, lugre, vibrated_lugre, vector_lugre };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 5> options{"coulomb", "dahl", "lugre", "vibrated_lugre", "vector_lugre"};
  static constexpr std::string_view option_key = "law";
  static constexpr unsigned kBristle = only(Law::dahl, Law::lugre, Law::vibrated_lugre, Law::vector_lugre);
  static constexpr unsigned kLugre = only(Law::lugre, Law::vibrated_lugre, Law::vector_lugre);
  static constexpr unsigned kVibrated = only(Law::vibrated_lugre);
  static constexpr unsigned options_of_two_axes = only(Law::vector_lugre);  ///< alone, `vector_lugre` is `lugre`

  template <class S>
  struct Params {
    using Scalar = S;
    int option = static_cast<int>(Law::lugre);
    S coulomb_torque{0.0};
    S stiffness{1e7};
    S static_ratio{1.0};
    S stribeck_velocity{0.01};
    S damping{0.0};
    S vibration_ratio{1.0};
    S vibration_velocity{0.01};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"coulomb_torque", "N.m", 0.0, 1e7, 8e3, "friction torque of steady sliding",
                        &Params::coulomb_torque},
          Field<Params>{"stiffness", "N.m/rad", 1e4, 1e11, 1e7, "bristle stiffness sigma0, before sliding",
                        &Params::stiffness, kBristle},
          Field<Params>{"static_ratio", "1", 1.0, 5.0, 1.2, "break-away torque over sliding torque", &Params::static_ratio,
                        kLugre},
          Field<Params>{"stribeck_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which static friction dies out",
                        &Params::stribeck_velocity, kLugre},
          Field<Params>{"damping", "N.m.s/rad", 0.0, 1e8, 1e3, "bristle damping sigma1", &Params::damping, kLugre},
          Field<Params>{"vibration_ratio", "1", 0.0, 1.0, 0.5, "friction left at rest under vibration",
                        &Params::vibration_ratio, kVibrated},
          Field<Params>{"vibration_velocity", "rad/s", 1e-6, 1.0, 0.01, "speed at which the loss to vibration dies out",
                        &Params::vibration_velocity, kVibrated}};
    }
  };

  template <class S>
  struct State {
    S deflection{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Motion<S>& input) noexcept {
    const Law law = law_of<GimbalFriction>(params);
    if (law == Law::coulomb) {
      return coulomb_force<S>(input, params.coulomb_torque);
    }
    // A level of zero is no friction: the bristle is not divided by it.
    const auto rubs = value_of(params.coulomb_torque) > 0.0;
    if (!anywhere(rubs)) {
      return S{0.0};
    }
    const S start = state.deflection;
    S torque = bristle(params, state, input, law);
    if (everywhere(rubs)) {
      return torque;
    }
    state.deflection = select(rubs, state.deflection, start);
    return select(rubs, torque, S{0.0});
  }

 private:
  /// The torque of a bristle by one of its laws.
  template <class S>
  static S bristle(const Params<S>& params, State<S>& state, const Motion<S>& input, Law law) noexcept {
    if (law == Law::dahl) {
      return bristle_force<S>(state.deflection, input, params.coulomb_torque, Bristle<S>{params.stiffness, S{0.0}, S{0.0}});
    }
    const S speed = speed_of<S>(input.velocity, law == Law::vector_lugre ? input.other_rate : S{0.0});
    if (law == Law::lugre || law == Law::vector_lugre) {
      const S level = stribeck_level<S>(speed, params.coulomb_torque, params.static_ratio, params.stribeck_velocity);
      return lugre(params, state, input, speed, level, params.coulomb_torque);
    }
    const S level = vibrated_stribeck_level<S>(speed, params.coulomb_torque, params.static_ratio, params.stribeck_velocity,
                                               params.vibration_ratio, params.vibration_velocity);
    return lugre(params, state, input, speed, level, S(params.coulomb_torque * params.vibration_ratio));
  }

  /// Length of the slip. At rest the root has no slope.
  template <class S>
  static S speed_of(const S& own, const S& other) noexcept {
    S along = own * sign_of(own);
    const auto turns_across = value_of(other) != 0.0;
    if (!anywhere(turns_across)) {
      return along;
    }
    const S squared = own * own + other * other;
    const auto has_length = value_of(squared) > 0.0;
    const S length = sqrt(select(has_length, squared, S{1.0}));
    return select(turns_across, select(has_length, length, along), along);
  }

  /// `least` is the least level that the law reaches: the bound of passivity holds for it.
  template <class S>
  static S lugre(const Params<S>& params, State<S>& state, const Motion<S>& input, const S& speed, const S& level,
                 const S& least) noexcept {
    const S damping = select(value_of(least) > 0.0, passive_damping<S>(params.damping, least, speed), S{0.0});
    return bristle_force<S>(state.deflection, input, speed, level, Bristle<S>{params.stiffness, damping, S{0.0}});
  }
};

}  // namespace hotfire::model
