// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Valve gain that differs between extend and retract: opening = x_v (1 + asymmetry sgn(x_v)).
struct ValveAsymmetry {
  static constexpr std::string_view name = "valve_asymmetry";
  static constexpr Site site = Site::valve;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S asymmetry{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"asymmetry", "1", -0.9, 0.9, 0.05,
                                      "relative gain added on extend and taken away on retract", &Params::asymmetry}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value * (1.0 + params.asymmetry * sign_of(input.value));
  }
};

}  // namespace hotfire::model
