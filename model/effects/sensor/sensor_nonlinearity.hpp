// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Bow of a potentiometer: y = x + quadratic x^2 + cubic x^3, in the channel's own unit.
struct SensorNonlinearity {
  static constexpr std::string_view name = "sensor_nonlinearity";
  static constexpr Site site = Site::sensor;
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S quadratic{0.0};
    S cubic{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"quadratic", "", -10.0, 10.0, 0.05, "error per reading squared, 1/m or 1/rad", &Params::quadratic},
          Field<Params>{"cubic", "", -100.0, 100.0, 0.5, "error per reading to the third power, 1/m^2 or 1/rad^2",
                        &Params::cubic}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value * (1.0 + input.value * (params.quadratic + params.cubic * input.value));
  }
};

}  // namespace hotfire::model
