// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Moment arm that follows the angle: R(beta) = R (1 + linear beta + quadratic beta^2). It applies to stroke (its integral)
/// and torque alike, so that it creates no energy. A plane linkage has this form to second order.
struct VariableMomentArm {
  static constexpr std::string_view name = "variable_moment_arm";
  static constexpr Site site = Site::load_spring;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S linear{0.0};
    S quadratic{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"linear", "1/rad", -5.0, 5.0, 0.1, "relative change of the arm per angle", &Params::linear},
          Field<Params>{"quadratic", "1/rad^2", -50.0, 50.0, -0.5, "relative change of the arm per angle squared",
                        &Params::quadratic}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>&, const Spring<S>& input) noexcept {
    Spring<S> output = input;
    const S& beta = input.angle;
    output.arm = input.arm * (1.0 + beta * (params.linear + params.quadratic * beta));
    output.deflection =
        input.deflection - input.arm * beta * beta * (0.5 * params.linear + (1.0 / 3.0) * params.quadratic * beta);
    return output;
  }
};

}  // namespace hotfire::model
