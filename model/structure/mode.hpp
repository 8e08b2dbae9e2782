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

/// `advance_mode` beside critical damping, where the damped frequency is zero and its derivatives are infinite. Its cosine
/// and sine are power series in the square of the frequency, which is small and of either sign.
template <class S>
ModeMotion<S> advance_nearly_critical_mode(const ModeMotion<S>& from, const S& w, const S& damping_ratio,
                                           double h) noexcept {
  constexpr int kTerms = 12;  // the last is below 1e-20 where the envelope is above 1e-40
  const S squared = (w * h) * (w * h) * (damping_ratio * damping_ratio - 1.0);
  S cosine_term{1.0};
  S sine_term{1.0};
  S cosine{1.0};
  S sine{1.0};
  for (int k = 1; k <= kTerms; ++k) {
    cosine_term = cosine_term * squared / ((2.0 * k - 1.0) * (2.0 * k));
    sine_term = sine_term * squared / ((2.0 * k) * (2.0 * k + 1.0));
    cosine += cosine_term;
    sine += sine_term;
  }
  const S decay_rate = damping_ratio * w;
  const S envelope = exp(-decay_rate * h);
  const S c = cosine * envelope;
  const S s = sine * envelope * h;
  return {from.displacement * c + (from.velocity + decay_rate * from.displacement) * s,
          from.velocity * c - (from.velocity * decay_rate + from.displacement * (w * w)) * s};
}

/// `advance_mode` for a damping ratio above 1, by its two real rates of decay: the slow one p, and p + gap.
template <class S>
ModeMotion<S> advance_overdamped_mode(const ModeMotion<S>& from, const S& w, const S& damping_ratio, double h) noexcept {
  using std::expm1;
  const S root = sqrt(damping_ratio * damping_ratio - 1.0);
  const S slow = w / (damping_ratio + root);
  const S fast = w * (damping_ratio + root);
  const S gap = 2.0 * w * root;
  const S fade = exp(-slow * h);
  const S spread = fade * (-expm1(-gap * h)) / gap;
  return {from.displacement * (fade + slow * spread) + from.velocity * spread,
          from.velocity * (fade - fast * spread) - from.displacement * (slow * fast) * spread};
}

/// `advance_mode` in a scalar that is a single number.
template <class S>
ModeMotion<S> advance_mode_of_number(const ModeMotion<S>& from, const S& w, const S& damping_ratio, double h) noexcept {
  using std::cos;
  using std::sin;
  constexpr double kNearlyCritical = 1e-3;  // off a damping ratio of 1: the series has full precision
  if (std::abs(value_of(damping_ratio) - 1.0) < kNearlyCritical) {
    return advance_nearly_critical_mode(from, w, damping_ratio, h);
  }
  if (value_of(damping_ratio) > 1.0) {
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

/// The exact advance of eta'' + 2 zeta w eta' + w^2 eta = 0 over `h` [s]. Under a force that is held it is that of the
/// deviation from force / w^2, where the mode would come to rest. `w` is the undamped natural frequency [rad/s], above 0;
/// zeta is 0 or more.
template <class S>
ModeMotion<S> advance_mode(const ModeMotion<S>& from, const S& w, const S& damping_ratio, double h) noexcept {
  if constexpr (are_lanes<S>) {
    ModeMotion<S> to;
    for (int lane = 0; lane < S::kLanes; ++lane) {
      const ModeMotion<double> own =
          advance_mode<double>({from.displacement[lane], from.velocity[lane]}, w[lane], damping_ratio[lane], h);
      to.displacement.set(lane, own.displacement);
      to.velocity.set(lane, own.velocity);
    }
    return to;
  } else {
    return advance_mode_of_number<S>(from, w, damping_ratio, h);
  }
}

}  // namespace hotfire::model
