// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Limited rate of the command: the output follows the command at no more than `rate`.
/// The output is the mean over the step. The neutral value is the upper bound, which means no limit.
struct RateLimit {
  static constexpr std::string_view name = "rate_limit";
  static constexpr Site site = Site::command;
  static constexpr NoOptions options{};

  static constexpr double kNoLimit = 1e6;  // rad/s

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S rate{kNoLimit};
    static constexpr auto fields() {
      return std::array{Field<Params>{"rate", "rad/s", 1e-3, kNoLimit, 0.2, "largest rate of the command", &Params::rate}};
    }
  };

  template <class S>
  struct State {
    S output{0.0};
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.output = input.value;
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    const auto is_limited = value_of(params.rate) < kNoLimit;
    if (!anywhere(is_limited)) {
      state.output = input.value;
      return input.value;
    }
    const S start = state.output;
    const S wanted = input.value - start;
    const S largest = params.rate * input.h;
    const S change = clamp_symmetric<S>(wanted, largest);
    state.output = select(is_limited, S(start + change), input.value);
    // Mean over the step: a ramp of slope `rate` for as long as it takes, then the command itself.
    const S ramp_part = change * sign_of(change) / largest;
    return select(is_limited, S(start + change * (1.0 - 0.5 * ramp_part)), input.value);
  }
};

}  // namespace hotfire::model
