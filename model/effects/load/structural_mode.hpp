// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "model/declaration/effect.hpp"
#include "model/structure/mode.hpp"

namespace hotfire::model {

/// One more lightly damped mode at the attach point (a damping ratio beyond 0.2 is no mode of a structure: it is creep):
///   eta'' + 2 zeta w eta' + w^2 eta = shape F,   motion = shape eta,   w = 2 pi frequency.
///
/// Advanced exactly with F held over the step (2x2 block), never by an explicit rule. Returns the mean motion over the step,
/// (eta + eta+)/2. The mode adds shape^2 / w^2 to the static compliance of the load.
/// [Hurty and Rubinstein 1964] Dynamics of Structures, ch. 8.
struct StructuralMode {
  static constexpr std::string_view name = "structural_mode";
  static constexpr Site site = Site::structure;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S frequency{1.0};
    S damping_ratio{0.02};
    S shape{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"frequency", "Hz", 0.1, 200.0, 6.0, "natural frequency of the mode", &Params::frequency},
          Field<Params>{"damping_ratio", "1", 1e-4, 0.2, 0.02, "damping ratio of the mode", &Params::damping_ratio},
          Field<Params>{"shape", "kg^-0.5", 0.0, 1.0, 3e-3, "mass-normalised shape at the attach point", &Params::shape}};
    }
  };

  template <class S>
  using State = ModeMotion<S>;

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const AttachPoint<S>& input) noexcept {
    const S w = params.frequency * (2.0 * std::numbers::pi);
    const S rest = params.shape * input.force / (w * w);
    const S start = state.displacement - rest;
    const ModeMotion<S> end = advance_mode<S>({start, state.velocity}, w, params.damping_ratio, input.h);
    const S mean = rest + 0.5 * (start + end.displacement);
    state = {rest + end.displacement, end.velocity};
    return params.shape * mean;
  }

  template <class S>
  static void settle(const Params<S>& params, State<S>& state, const AttachPoint<S>& input) noexcept {
    const S w = params.frequency * (2.0 * std::numbers::pi);
    state = {params.shape * input.force / (w * w), S{0.0}};
  }
};

}  // namespace hotfire::model
