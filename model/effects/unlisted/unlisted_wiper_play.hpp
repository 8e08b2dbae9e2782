// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// A reading that stays constant until the motion exceeds a play, and then follows at that distance: a wiper that sticks,
/// slack in the linkage that moves it. The stop operator of Krasnosel'skii, as in `valve_hysteresis`.
struct UnlistedWiperPlay {
  static constexpr std::string_view name = "unlisted_wiper_play";
  static constexpr Site site = Site::sensor;
  static constexpr bool is_unlisted = true;
  enum class Law { piston, engine };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    S half_angle{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"half_width", "m", 0.0, 1.0, 1e-4, "half of the play", &Params::half_width, only(Law::piston)},
          Field<Params>{"half_angle", "rad", 0.0, 1.0, 2e-4, "half of the play", &Params::half_angle, only(Law::engine)}};
    }
  };

  template <class S>
  struct State {
    S distance{0.0};  ///< motion minus reading, within the play
    S last{0.0};      ///< motion at the last step
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.distance = S{0.0};
    state.last = input.value;
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    state.distance = stop_after<S>(state.distance, input.value - state.last,
                                   law_of<UnlistedWiperPlay>(params) == Law::piston ? params.half_width : params.half_angle);
    state.last = input.value;
    return input.value - state.distance;
  }
};

}  // namespace hotfire::model
