// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

namespace hotfire {

/// The largest integer up to which a double has every one: 2^53.
inline constexpr std::int64_t kLargestExactInteger = std::int64_t{1} << std::numeric_limits<double>::digits;

/// True for an integer that no rounding changes on its way to a double.
template <std::integral T>
constexpr bool is_exact(T value) noexcept {
  if constexpr (sizeof(T) < sizeof(std::int64_t)) {
    return true;
  } else {
    constexpr T kMost = static_cast<T>(kLargestExactInteger);
    return value <= kMost && (std::unsigned_integral<T> || value >= T{0} - kMost);
  }
}

}  // namespace hotfire
