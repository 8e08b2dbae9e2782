// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The stop operator of a width after a change of its input: the part of the changes that stays within the width. The input
/// less its stop is a play of that half width [Krasnosel'skii and Pokrovskii 1989, Systems with Hysteresis].
template <class S>
constexpr S stop_after(const S& stop, const S& change, const S& width) noexcept {
  return clamp_symmetric<S>(stop + change, width);
}

/// First-order lag, time y' + y = s, over a step of `h` [s] in which the input `s` is held. Advances `y` to the end of the
/// step and returns its mean over the step.
template <class S>
S lag_of_held(S& y, const S& s, const S& time, double h) noexcept {
  const S behind = y - s;
  const S left = fading_exponential<S>(h / time);
  y = s + behind * left;
  return s + behind * (1.0 - left) * (time / h);
}

/// The same lag of an input that moves. Advances `y` to the end of the step and returns the mean of its two ends.
template <class S>
S lag_of_moving(S& y, const S& s, const S& time, double h) noexcept {
  const S start = y;
  y = s + (start - s) * fading_exponential<S>(h / time);
  return 0.5 * (start + y);
}

}  // namespace hotfire::model
