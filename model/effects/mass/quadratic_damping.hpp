// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Drag of a turbulent flow (an orifice, a fluid around the body), with its own value per direction: force = c v abs(v),
/// beside the declared damping [Merritt 1967, Hydraulic Control Systems, ch. 3].
///
/// The force of a step and the velocity that it leaves are solved together: of c v^2 and v = free velocity - compliance *
/// force, the root is v = 2 u / (1 + sqrt(1 + 4 compliance c u)) at the free velocity u.
struct QuadraticDamping {
  static constexpr std::string_view name = "quadratic_damping";
  static constexpr Site site = Site::mass_force;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S forward{0.0};
    S backward{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"forward", "force.time^2/position^2", 0.0, 1e12, 0.1,
                                      "force per velocity squared, forward", &Params::forward},
                        Field<Params>{"backward", "force.time^2/position^2", 0.0, 1e12, 0.1,
                                      "force per velocity squared, backward", &Params::backward}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    const double sign = sign_of(input.free_velocity);
    const S& drag = sign > 0.0 ? params.forward : params.backward;
    const S free_speed = sign * input.free_velocity;
    const S speed = 2.0 * free_speed / (1.0 + sqrt(1.0 + 4.0 * input.compliance * drag * free_speed));
    return sign * drag * speed * speed;
  }
};

}  // namespace hotfire::model
