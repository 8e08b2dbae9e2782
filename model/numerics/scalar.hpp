// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <type_traits>

namespace hotfire::model {

/// The model runs in double (rig and offline), float (small targets) and dual numbers (gradients of a fit). Functions of
/// <cmath> are called unqualified after `using`, so that a dual number brings its own by argument-dependent lookup.
using std::abs;
using std::exp;
using std::sqrt;

/// The scalar of what 24 bits do not hold: the constants of a run, and its time. It is double for a float model, and the
/// model's own scalar otherwise.
template <class S>
using Precise = std::conditional_t<std::is_same_v<S, float>, double, S>;

/// The plain value behind a scalar: itself for a floating-point number, the real part of a dual number.
template <std::floating_point S>
constexpr double value_of(S x) noexcept {
  return static_cast<double>(x);
}

/// Real part of a dual number: any type with a member `a`, which is what ceres::Jet calls it.
template <class Dual>
requires requires(const Dual& x) { x.a; }
constexpr double value_of(const Dual& x) noexcept { return static_cast<double>(x.a); }

/// -1, 0 or 1, by value.
template <class S>
constexpr double sign_of(const S& x) noexcept {
  const double value = value_of(x);
  return static_cast<double>(value > 0.0) - static_cast<double>(value < 0.0);
}

/// e^-x for x >= 0, cut off at `kLongestFade`: beyond it the result, 1e-217, is nothing to any user, while the C library
/// would leave its usual path towards denormal numbers.
inline constexpr double kLongestFade = 500.0;
template <class S>
S fading_exponential(const S& x) noexcept {
  return exp(-(value_of(x) < kLongestFade ? x : S{kLongestFade}));
}

/// `x` limited to [-limit, limit]; the derivative is that of whichever bound is active.
template <class S>
constexpr S clamp_symmetric(const S& x, const S& limit) noexcept {
  if (x > limit) {
    return limit;
  }
  if (x < -limit) {
    return -limit;
  }
  return x;
}

}  // namespace hotfire::model
