// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// Play between the valve's command and its spool (friction in torque motor and spool). The output stays constant until the
/// command has moved by `half_width`, then follows at that distance. The stop operator of Krasnosel'skii.
struct ValveHysteresis {
  static constexpr std::string_view name = "valve_hysteresis";
  static constexpr Site site = Site::valve_command;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"half_width", "1", 0.0, 0.3, 0.01, "half of the play, in valve command", &Params::half_width}};
    }
  };

  template <class S>
  struct State {
    S distance{0.0};  ///< command minus output, within +- half_width
    S last{0.0};      ///< command at the end of the last step
  };

  /// Before the first step the command was `before`, in the middle of the play.
  template <class S>
  static void come_from(State<S>& state, const S& before) noexcept {
    state.distance = S{0.0};
    state.last = before;
  }

  /// The command runs straight from its start to its end; the mean of the play over that line is exact.
  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    const S half_change = 0.5 * input.change;
    const S start = stop_after<S>(state.distance, input.value - half_change - state.last, params.half_width);
    const S end = stop_after<S>(start, input.change, params.half_width);
    // The share of the step after which the play is taken up.
    const S share = select(value_of(input.change) != 0.0, S((end - start) / input.change), S{0.0});
    state.distance = end;
    state.last = input.value + half_change;
    return input.value - (end - 0.5 * share * (end - start));
  }
};

}  // namespace hotfire::model
