// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace hotfire::model {

/// Up to `Capacity` points of a curve, `x` strictly increasing. Plain data; what is between the points is the user's law.
template <class S, std::size_t Capacity>
struct Table {
  static constexpr std::size_t kCapacity = Capacity;
  std::array<S, Capacity> x{};
  std::array<S, Capacity> y{};
  int points = 0;
};

}  // namespace hotfire::model
