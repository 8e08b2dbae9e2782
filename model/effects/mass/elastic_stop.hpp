// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// A further spring that the body meets after a clearance on either side: force = stiffness (x - forward) beyond the forward
/// clearance, stiffness (x + backward) beyond the backward one, and none between [Shaw and Holmes 1983, J. Sound Vib. 90,
/// pp. 129-155].
struct ElasticStop {
  static constexpr std::string_view name = "elastic_stop";
  static constexpr Site site = Site::mass_force;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S stiffness{0.0};
    S forward{0.0};
    S backward{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"stiffness", "force/position", 0.0, 1e15, 0.5, "stiffness of the stop", &Params::stiffness},
          Field<Params>{"forward", "position", 0.0, 1e9, 0.5, "clearance before the stop, forward", &Params::forward},
          Field<Params>{"backward", "position", 0.0, 1e9, 0.5, "clearance before the stop, backward", &Params::backward}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    if (input.position > params.forward) {
      return params.stiffness * (input.position - params.forward);
    }
    if (input.position < -params.backward) {
      return params.stiffness * (input.position + params.backward);
    }
    return S{0.0};
  }
};

}  // namespace hotfire::model
