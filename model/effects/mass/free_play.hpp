// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// Free play of the joint through which the declared spring or the declared damper acts:
///
/// - `spring`: no spring force while abs(x) < half_width, the declared stiffness beyond it (a dead zone);
/// - `damper`: the damper moves only after the body has taken up the play, in either direction (the play operator of
///   [Krasnosel'skii and Pokrovskii 1989, Systems with Hysteresis]).
///
/// The effect takes the force of the declared part back where the play takes up the motion.
struct FreePlay {
  static constexpr std::string_view name = "free_play";
  static constexpr Site site = Site::mass_force;
  enum class Law { spring, damper };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"spring", "damper"};
  static constexpr std::string_view option_key = "of";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"half_width", "position", 0.0, 1e9, 0.1, "half of the free play", &Params::half_width}};
    }
  };

  template <class S>
  struct State {
    S taken_up{0.0};  ///< motion of the body that the damper has not followed
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Motion<S>& input) noexcept {
    if (law_of<FreePlay>(params) == Law::spring) {
      return -input.declared_stiffness * clamp_symmetric<S>(input.position, params.half_width);
    }
    const S before = state.taken_up;
    state.taken_up = stop_after<S>(before, S(input.velocity * input.h), params.half_width);
    return -input.declared_damping * (state.taken_up - before) / input.h;
  }
};

}  // namespace hotfire::model
