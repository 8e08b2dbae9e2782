// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/delay_line.hpp"

namespace hotfire::model {

/// A measured channel whose clock is late, or early if `delay` is negative. The reading is the value `delay` ago, or its
/// extrapolation (`DelayLine`).
struct SensorDelay {
  static constexpr std::string_view name = "sensor_delay";
  static constexpr Site site = Site::sensor;
  static constexpr std::array<std::string_view, 3> options{"piston", "engine", "load_pressure"};
  static constexpr std::string_view option_key = "channel";
  static constexpr std::size_t kCapacity = 1024;
  static constexpr double kLongestDelay = 0.05;  // s
  static_assert(kLongestDelay / kShortestDelayedStep < kCapacity - 1);

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S delay{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"delay", "s", -kLongestDelay, kLongestDelay, 0.005,
                                      "how late the channel is; early: negative", &Params::delay}};
    }
  };

  template <class S>
  struct State {
    DelayLine<S, kCapacity> readings;
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.readings.fill(input.value);
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    return state.readings.pass(input.value, params.delay, input.h);
  }
};

}  // namespace hotfire::model
