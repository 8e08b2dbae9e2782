// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// A curve at `at`, from its first `points` points: linear between them, constant beyond them, zero without any. The time
/// depends on the number of points alone.
template <class S, class Points, class X>
S curve_value(const Points& x, const Points& y, std::size_t points, const X& at) noexcept {
  if (points == 0) {
    return S{0.0};
  }
  if (points == 1) {
    return y[0];
  }
  std::size_t below = 0;  // the point at which the segment of `at` starts
  for (std::size_t k = 1; k + 1 < points; ++k) {
    below += value_of(at) > value_of(x[k]) ? 1 : 0;
  }
  const S share((at - x[below]) / (x[below + 1] - x[below]));
  const S inside = value_of(share) < 1.0 ? share : S{1.0};
  return y[below] + (y[below + 1] - y[below]) * (value_of(inside) > 0.0 ? inside : S{0.0});
}

/// Up to `Capacity` points of a curve, `x` strictly increasing. Plain data; the user decides what is between the points.
template <class S, std::size_t Capacity>
struct Table {
  static constexpr std::size_t kCapacity = Capacity;
  std::array<S, Capacity> x{};
  std::array<S, Capacity> y{};
  int points = 0;
};

}  // namespace hotfire::model
