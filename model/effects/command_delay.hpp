#pragma once

#include "model/delay_line.hpp"
#include "model/effect.hpp"

namespace hotfire::model {

/// Transport delay of the command: x(t) -> x(t - delay), exact for a command that is held between steps (`DelayLine`). The
/// memory holds the longest delay at the shortest step, that of a 20 kHz record.
struct CommandDelay {
  static constexpr std::string_view name = "command_delay";
  static constexpr Site site = Site::command;
  static constexpr NoOptions options{};
  static constexpr std::size_t kCapacity = 2048;
  static constexpr double kLongestDelay = 0.1;   // s
  static constexpr double kShortestStep = 5e-5;  // s
  static_assert(kLongestDelay / kShortestStep < kCapacity - 1);

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S delay{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"delay", "s", 0.0, kLongestDelay, 0.005, "transport delay of the command", &Params::delay}};
    }
  };

  template <class S>
  struct State {
    DelayLine<S, kCapacity> commands;
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
