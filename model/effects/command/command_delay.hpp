// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/delay_line.hpp"

namespace hotfire::model {

/// Transport delay of the command: x(t) -> x(t - delay), exact for a command that is held between steps (`DelayLine`).
struct CommandDelay {
  static constexpr std::string_view name = "command_delay";
  static constexpr Site site = Site::command;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S delay{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"delay", "s", 0.0, kLongestCommandDelay, 0.005, "transport delay of the command", &Params::delay}};
    }
  };

  template <class S>
  struct State {
    DelayLine<S, kCommandMemory> commands;
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.commands.fill(input.value);
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    return state.commands.pass(input.value, params.delay, input.h);
  }
};

}  // namespace hotfire::model
