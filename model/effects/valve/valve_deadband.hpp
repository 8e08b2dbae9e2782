// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Spool lap: no flow while abs(x_v) < half_width, the flow curve shifted by the lap beyond it.
///   opening = x_v - clamp(x_v, -half_width, half_width)
/// [Merritt 1967] Hydraulic Control Systems, sec. 5-5 (overlapped valves).
struct ValveDeadband {
  static constexpr std::string_view name = "valve_deadband";
  static constexpr Site site = Site::valve;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"half_width", "1", 0.0, 0.5, 0.02, "spool travel to either side without flow", &Params::half_width}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value - clamp_symmetric<S>(input.value, params.half_width);
  }
};

}  // namespace hotfire::model
