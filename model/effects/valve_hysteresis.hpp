#pragma once

#include "model/effect.hpp"
#include "model/scalar.hpp"

namespace hotfire::model {

/// Play between the valve's command and its spool (friction in torque motor and spool): the output stays where it is until
/// the command has moved by `half_width`, then follows at that distance. The stop operator of Krasnosel'skii.
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
    S last{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    state.distance = clamp_symmetric<S>(state.distance + (input.value - state.last), params.half_width);
    state.last = input.value;
    return input.value - state.distance;
  }
};

}  // namespace hotfire::model
