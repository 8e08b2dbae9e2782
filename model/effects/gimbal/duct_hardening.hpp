// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Propellant ducts that stiffen with the angle: torque = cubic beta^3, beside the declared linear duct stiffness.
struct DuctHardening {
  static constexpr std::string_view name = "duct_hardening";
  static constexpr Site site = Site::engine_torque;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S cubic{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"cubic", "N.m/rad^3", -1e10, 1e10, 1e7, "torque per angle to the third power", &Params::cubic}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    return params.cubic * input.position * input.position * input.position;
  }
};

}  // namespace hotfire::model
