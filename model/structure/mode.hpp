// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// One mode of a structure, mass-normalised: displacement eta [m kg^0.5] and its rate.
template <class S>
struct ModeMotion {
  S displacement{0.0};
  S velocity{0.0};
};

/// `advance_mode` for a damping ratio of 1 or more, by its two real rates of decay: the slow one p, and p + gap. Their
/// difference is never divided by where it vanishes.
template <class S>
ModeMotion<S> advance_overdamped_mode(const ModeMotion<S>& from, const S& w, const S& damping_ratio, double h) noexcept {
  using std::expm1;
  const S root = sqrt(damping_ratio * damping_ratio - 1.0);
  const S slow = w / (damping_ratio + root);
  const S fast = w * (damping_ratio + root);
  const S gap = 2.0 * w * root;
  const S fade = exp(-slow * h);
  const S spread = value_of(gap) > 0.0 ? S(fade * (-expm1(-gap * h)) / gap) : S(fade * h);
  return {from.displacement * (fade + slow * spread) + from.velocity * spread,
          from.velocity * (fade - fast * spread) - from.displacement * (slow * fast) * spread};
}

/// The exact advance of eta'' + 2 zeta w eta' + w^2 eta = 0 over `h` [s]. Under a force that is held it is that of the
/// deviation from force / w^2, where the mode would come to rest. `w` is the undamped natural frequency [rad/s], above 0;
/// zeta is 0 or more.
template <class S>
ModeMotion<S> advance_mode(const ModeMotion<S>& from, const S& w, const S& damping_ratio, double h) noexcept {
  using std::cos;
  using std::sin;
  if (!(value_of(damping_ratio) < 1.0)) {
    return advance_overdamped_mode(from, w, damping_ratio, h);
  }
  const S decay_rate = damping_ratio * w;
  const S damped = w * sqrt(1.0 - damping_ratio * damping_ratio);
  const S envelope = exp(-decay_rate * h);
  const S c = cos(damped * h) * envelope;
  const S s = sin(damped * h) * envelope;
  return {from.displacement * c + (from.velocity + decay_rate * from.displacement) / damped * s,
          from.velocity * c - (from.velocity * decay_rate + from.displacement * (w * w)) / damped * s};
}

}  // namespace hotfire::model
