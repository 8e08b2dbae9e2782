// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Stiffness that differs between the two directions: force = stiffness x^2, beside the declared linear stiffness.
struct QuadraticStiffness {
  static constexpr std::string_view name = "quadratic_stiffness";
  static constexpr Site site = Site::mass_force;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S stiffness{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"stiffness", "force/position^2", -1e15, 1e15, 0.05, "force per position squared",
                                      &Params::stiffness}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    return params.stiffness * input.position * input.position;
  }
};

}  // namespace hotfire::model
