#pragma once

#include "model/effect.hpp"
#include "model/scalar.hpp"

namespace hotfire::model {

/// Transport delay of the command: x(t) -> x(t - delay).
///
/// The command is held between steps, so a delay of k + f steps (0 <= f < 1) makes the mean over a step
/// (1 - f) x[n-k] + f x[n-k-1]. Exact for any delay, and differentiable in it.
/// The memory holds the longest delay at the shortest step, that of a 20 kHz record; beyond both it would extrapolate.
/// Source: transport lag e^{-sT}, any text on control.
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

  /// The newest `kCapacity` commands, as a ring.
  template <class S>
  struct State {
    std::array<S, kCapacity> commands{};
    std::size_t newest = 0;
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    state.commands.fill(input.value);
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    state.newest = (state.newest + 1) % kCapacity;
    state.commands[state.newest] = input.value;
    const S steps = params.delay / input.h;
    const double plain = value_of(steps);
    constexpr auto kLongest = static_cast<double>(kCapacity - 2);
    const auto whole = static_cast<std::size_t>(plain < kLongest ? plain : kLongest);
    const S& later = state.commands[(state.newest + kCapacity - whole) % kCapacity];
    const S& earlier = state.commands[(state.newest + kCapacity - whole - 1) % kCapacity];
    return later + (earlier - later) * (steps - static_cast<double>(whole));
  }
};

}  // namespace hotfire::model
