// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The time of a record, counted in steps. A sum of step sizes would stop growing in float after some hours. In double it
/// would be off by the sum of its rounding errors. After a day a float resolves 8 ms, so the time itself is a `Precise`.
template <class S>
struct Clock {
  Precise<S> start{0.0};  ///< time at no step [s]
  double steps = 0.0;     ///< a whole number, exact up to 2^53: 140,000 years of 0.5 ms

  /// The time `part` of a step of `h` [s] from here [s].
  Precise<S> at(double h, double part = 0.0) const noexcept { return start + (steps + part) * h; }
};

}  // namespace hotfire::model
