// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>
#include <type_traits>
#include <utility>

namespace hotfire::model {

/// The model runs in double (rig and offline), float (small targets), dual numbers (linear models) and numbers side by side
/// (gradients of a fit). Functions of <cmath> are called unqualified after `using`, so that such a number brings its own by
/// argument-dependent lookup.
using std::abs;
using std::exp;
using std::sqrt;

/// The scalar for quantities that need more than 24 bits: the constants of a run, and its time. It is double for a float
/// model, and the model's own scalar otherwise.
template <class S>
using Precise = std::conditional_t<std::is_same_v<S, float>, double, S>;

/// True for a scalar that is several numbers side by side (lanes.hpp).
template <class S>
inline constexpr bool are_lanes = requires {
  S::kLanes;
};

/// The plain value behind a scalar: itself for a floating-point number, the real part of a dual number.
template <std::floating_point S>
constexpr double value_of(S x) noexcept {
  return static_cast<double>(x);
}

/// Real part of a dual number: any type with a member `a`, which is what ceres::Jet calls it.
template <class Dual>
requires requires(const Dual& x) { x.a; }
constexpr double value_of(const Dual& x) noexcept { return static_cast<double>(x.a); }

/// The type of the plain value behind a scalar.
template <class S>
using Plain = std::remove_cvref_t<decltype(value_of(std::declval<const S&>()))>;

// Choices by value. A condition is a bool, or one for each of several numbers side by side (`Lanes`), which the model then
// computes both ways. A branch that saves time asks `everywhere` or `anywhere`, and is right for a mixture as well.

template <class S>
constexpr S select(bool condition, const S& where_true, const S& where_false) noexcept {
  return condition ? where_true : where_false;
}
/// 1 where the condition holds, 0 elsewhere: a weight that makes no branch.
constexpr double one_where(bool condition) noexcept { return static_cast<double>(condition); }
constexpr bool everywhere(bool condition) noexcept { return condition; }
constexpr bool anywhere(bool condition) noexcept { return condition; }

/// -1, 0 or 1, by value.
template <class S>
constexpr double sign_of(const S& x) noexcept {
  const double value = value_of(x);
  return value != 0.0 ? __builtin_copysign(1.0, value) : 0.0;
}

/// e^-x for x >= 0, cut off at `kLongestFade`: beyond it the result, 1e-217, is nothing to any user.
///
/// Most of the laws of friction and soft springs are made of it. It is written out because the C library's function costs
/// twice as much, and has other last bits on processors with fused multiplication and in other versions of the library.
/// x = k ln 2 + r with |r| <= ln 2 / 2, e^-r by its series to r^13 (4e-18), 2^-k by its bits: within 2 units of the last
/// place.
inline constexpr double kLongestFade = 500.0;
inline constexpr double kWholeNumbers = 0x1.8p52;  // added to a number below 2^51 it rounds to whole numbers

/// e^-r of that, for x = `limited` and k = `whole`.
template <class S>
[[gnu::always_inline]] inline S fading_series(const S& limited, const S& whole) noexcept {
  constexpr double kLog2 = 0x1.62e42fee00000p-1;
  constexpr double kRestOfLog2 = 0x1.a39ef35793c76p-33;
  const S r = (whole * kLog2 - limited) + whole * kRestOfLog2;
  const S r2 = r * r;
  const S r4 = r2 * r2;
  // 1 / n!, grouped by powers of r^4 so that the processor works on several at once.
  const S low = 1.0 + r + r2 * (1.0 / 2 + r * (1.0 / 6));
  const S middle = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
  const S high = (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
  const S highest = 1.0 / 479001600 + r * (1.0 / 6227020800.0);
  return low + r4 * (middle + r4 * (high + r4 * highest));
}

inline double plain_fading_exponential(double x) noexcept {
  double limited = x < kLongestFade ? x : kLongestFade;
  // The compiler must not know the number: it would branch to the constant result of the limit, and the time of a step would
  // depend on the state.
#if defined(__SSE2__)
  __asm__("" : "+x"(limited));
#elif defined(__aarch64__)
  __asm__("" : "+w"(limited));
#endif
  const double shifted = limited * std::numbers::log2e + kWholeNumbers;
  const double series = fading_series(limited, shifted - kWholeNumbers);
  // The last bits of `shifted` are k.
  const auto power = (std::uint64_t{1023} << 52) - (std::bit_cast<std::uint64_t>(shifted) << 52);
  return series * std::bit_cast<double>(power);
}

template <std::floating_point S>
S fading_exponential(const S& x) noexcept {
  if constexpr (std::is_same_v<S, double>) {
    return plain_fading_exponential(x);
  } else {
    return exp(-(x < S(kLongestFade) ? x : S(kLongestFade)));
  }
}

/// The same of a dual number.
template <class Dual>
requires requires(const Dual& x) { x.a; }
Dual fading_exponential(const Dual& x) noexcept {
  Dual result = x;
  result.a = plain_fading_exponential(value_of(x));
  result.v = value_of(x) < kLongestFade ? decltype(x.v)(-result.a * x.v) : decltype(x.v)(0.0 * x.v);
  return result;
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
