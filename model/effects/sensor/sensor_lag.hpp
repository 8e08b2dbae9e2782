// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// First-order lag in one measured channel: time_constant y' + y = x, exact for an x that moves linearly over the step.
struct SensorLag {
  static constexpr std::string_view name = "sensor_lag";
  static constexpr Site site = Site::sensor;
  static constexpr std::array<std::string_view, 3> options{"piston", "engine", "load_pressure"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S time_constant{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"time_constant", "s", 0.0, 1.0, 0.005, "time constant of the channel's lag",
                                      &Params::time_constant}};
    }
  };

  template <class S>
  struct State {
    S output{0.0};
    S last{0.0};
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.output = input.value;
    state.last = input.value;
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    const S slope = input.value - state.last;
    state.last = input.value;
    // Below a thousandth of the step the lag is that of the linear motion itself, tau times the slope.
    const auto is_short = value_of(params.time_constant) < 1e-3 * input.h;
    const S ratio = params.time_constant / input.h;
    const S behind = input.value - slope * ratio;
    if (everywhere(is_short)) {
      state.output = behind;
      return state.output;
    }
    const S decay = exp(-1.0 / ratio);
    state.output = select(is_short, behind, S(behind + (state.output - (behind - slope)) * decay));
    return state.output;
  }
};

}  // namespace hotfire::model
