// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Free play between piston and engine, or in the transmission of a motor (`at`): no force while abs(deflection) <
/// half_width, the spring beyond it. A damper beside the spring of a transmission acts in the play too.
template <Site at>
struct BacklashAt {
  static constexpr std::string_view name = "backlash";
  static constexpr Site site = at;
  static constexpr bool is_of_axis = at == Site::load_spring;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"half_width", is_of_axis ? "m" : "position", 0.0, is_of_axis ? 0.01 : 1e9,
                                      is_of_axis ? 1e-4 : 0.02, "half of the free play", &Params::half_width}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>&, const Spring<S>& input) noexcept {
    Spring<S> output = input;
    output.deflection = input.deflection - clamp_symmetric<S>(input.deflection, params.half_width);
    return output;
  }
};

/// Of a hydraulic axis.
using Backlash = BacklashAt<Site::load_spring>;

}  // namespace hotfire::model
