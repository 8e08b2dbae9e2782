// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// A curve at `at`, from its first `points` points: linear between them, constant beyond them, zero without any.
template <class S, class Points, class X>
S curve_value(const Points& x, const Points& y, std::size_t points, const X& at) noexcept {
  if (points == 0) {
    return S{0.0};
  }
  S value = y[0];
  for (std::size_t k = 1; k < points; ++k) {
    const S share((at - x[k - 1]) / (x[k] - x[k - 1]));
    const S inside = value_of(share) < 1.0 ? share : S{1.0};
    value += (y[k] - y[k - 1]) * (value_of(inside) > 0.0 ? inside : S{0.0});
  }
  return value;
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
