// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Null bias of a servovalve: it is closed at the command -bias, not at zero. Temperature, supply pressure and age move it
/// by a few percent of the rated current.
///   u = K_e (x_c - x_a) - K_d (...) + bias
/// A servo answers with a constant position error of bias / K_e, as it would to a command that is off by as much.
/// [SAE ARP490] Electrohydraulic Servovalves, definition of null bias.
struct ValveBias {
  static constexpr std::string_view name = "valve_bias";
  static constexpr Site site = Site::valve_command;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S bias{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"bias", "1", -0.5, 0.5, 0.02, "valve command that is there without an error", &Params::bias}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value + params.bias;
  }
};

}  // namespace hotfire::model
