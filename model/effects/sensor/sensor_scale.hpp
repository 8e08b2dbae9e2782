// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// A mis-scaled channel: it reads (1 + error) times the true value. It is a fault of a calibration and not of the plant:
/// correct the record instead of running the plant with it.
struct SensorScale {
  static constexpr std::string_view name = "sensor_scale";
  static constexpr Site site = Site::sensor;
  static constexpr std::array<std::string_view, 3> options{"piston", "engine", "load_pressure"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S error{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"error", "1", -0.8, 4.0, 0.02, "relative error of the channel's scale", &Params::error}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value * (1.0 + params.error);
  }
};

}  // namespace hotfire::model
