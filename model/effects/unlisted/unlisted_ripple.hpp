// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"

namespace hotfire::model {

/// A sinusoid of time in a sensor's reading that is not in the motion: mains hum, a supply that ripples.
struct UnlistedRipple {
  static constexpr std::string_view name = "unlisted_ripple";
  static constexpr Site site = Site::sensor;
  static constexpr bool is_unlisted = true;
  enum class Law { piston, engine };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S frequency{1.0};
    S amplitude{0.0};
    S angle{0.0};
    S phase{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"frequency", "Hz", 1e-3, 1e3, 50.0, "frequency of the sinusoid", &Params::frequency, ~0U},
          Field<Params>{"amplitude", "m", 0.0, 1.0, 1e-4, "amplitude of the sinusoid", &Params::amplitude,
                        only(Law::piston)},
          Field<Params>{"angle", "rad", 0.0, 1.0, 1e-4, "amplitude of the sinusoid", &Params::angle, only(Law::engine)},
          unlisted::phase_field<Params>(~0U)};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value + unlisted::periodic(params,
                                            law_of<UnlistedRipple>(params) == Law::piston ? params.amplitude : params.angle,
                                            input.time);
  }
};

}  // namespace hotfire::model
