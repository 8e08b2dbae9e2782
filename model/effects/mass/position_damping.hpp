// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Damping that depends on the position: force = (linear x + quadratic x^2) v, beside the declared damping.
struct PositionDamping {
  static constexpr std::string_view name = "position_damping";
  static constexpr Site site = Site::mass_force;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S linear{0.0};
    S quadratic{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"linear", "force.time/position^2", -1e12, 1e12, 0.02, "damping per position", &Params::linear},
          Field<Params>{"quadratic", "force.time/position^3", -1e12, 1e12, 0.02, "damping per position squared",
                        &Params::quadratic}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    return (params.linear + params.quadratic * input.position) * input.position * input.velocity;
  }
};

}  // namespace hotfire::model
