// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <type_traits>

#include "model/numerics/exact_hold.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// True if a vector register of the target holds several numbers in double.
#if defined(__SSE2__) || defined(__aarch64__)
inline constexpr bool kHasRegistersOfLanes = true;
#else
inline constexpr bool kHasRegistersOfLanes = false;
#endif

/// Numbers that one register holds. The bits of a lane do not depend on it. A unit that is compiled for AVX has names of its
/// own: the same program may have others that are not.
#if defined(__AVX__)
inline constexpr int kLanesOfRegister = 4;
inline namespace registers_of_four {
#else
inline constexpr int kLanesOfRegister = 2;
inline namespace registers_of_two {
#endif

namespace vectors {

// The vectors of the compiler.
inline constexpr int kWidth = kLanesOfRegister;
using Numbers [[gnu::vector_size(8 * kWidth)]] = double;
using Words [[gnu::vector_size(8 * kWidth)]] = std::int64_t;
using Bits [[gnu::vector_size(8 * kWidth)]] = std::uint64_t;

/// The same in every lane.
inline Numbers all(double value) noexcept { return value - Numbers{}; }
inline Bits all(std::uint64_t value) noexcept { return value - Bits{}; }

/// The square roots: each is correctly rounded.
inline Numbers root_of(const Numbers& x) noexcept {
#if defined(__AVX__)
  return __builtin_ia32_sqrtpd256(x);
#else
  return Numbers{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}

inline constexpr int kAllBits = (1 << kWidth) - 1;
/// One bit for each lane.
inline int bits_of(const Words& mask) noexcept {
#if defined(__AVX__)
  return __builtin_ia32_movmskpd256(std::bit_cast<Numbers>(mask));
#else
  return static_cast<int>((mask[0] & 1) | (mask[1] & 2));
#endif
}

}  // namespace vectors

/// A condition for each of `N` lanes.
template <int N>
struct LaneMask {
  std::array<vectors::Words, static_cast<std::size_t>(N / vectors::kWidth)> parts;  ///< all bits of a lane, or none
};

/// `N` numbers side by side, a scalar in which the model runs `N` plants at once. Each lane has the bits of a plant that
/// runs alone in double: the operations are the same, and a choice (`select`) computes both of its values.
///
/// The lanes share what is not a number: the active effects, their laws and the number of points of their tables.
template <int N>
struct Lanes {
  static_assert(N % vectors::kWidth == 0);
  static constexpr int kLanes = N;
  static constexpr std::size_t kParts = static_cast<std::size_t>(N / vectors::kWidth);
  /// What holds lanes has the same layout whatever registers a unit is compiled for.
  static constexpr std::size_t kAlignment = N % 4 == 0 ? 32 : 16;
  alignas(kAlignment) std::array<vectors::Numbers, kParts> parts;

  Lanes() = default;
  // Written out, because a copy by the bytes goes in halves of a register, and a processor waits for them when it reads the
  // whole.
  Lanes(const Lanes& other) noexcept { copy(other); }
  Lanes& operator=(const Lanes& other) noexcept {  // NOLINT(bugprone-unhandled-self-assignment): its own value
    copy(other);
    return *this;
  }
  template <class T>
  // NOLINTNEXTLINE(google-explicit-constructor): as a number converts
  requires std::is_arithmetic_v<T> Lanes(T value)
  noexcept {
    const vectors::Numbers all = vectors::all(static_cast<double>(value));
    for (auto& part : parts) {
      part = all;
    }
  }

  /// `N` numbers beside each other in memory.
  static Lanes load(const double* from) noexcept {
    return by_part<Lanes>([&](std::size_t i) {
      vectors::Numbers part;
      __builtin_memcpy(&part, from + i * vectors::kWidth, sizeof part);
      return part;
    });
  }
  void store(double* to) const noexcept {
    for (std::size_t i = 0; i < kParts; ++i) {
      __builtin_memcpy(to + i * vectors::kWidth, &parts[i], sizeof parts[i]);
    }
  }

  double operator[](int lane) const noexcept {
    return parts[static_cast<std::size_t>(lane / vectors::kWidth)][lane % vectors::kWidth];
  }
  void set(int lane, double value) noexcept {
    parts[static_cast<std::size_t>(lane / vectors::kWidth)][lane % vectors::kWidth] = value;
  }

  Lanes& operator+=(const Lanes& y) noexcept { return *this = *this + y; }
  Lanes& operator-=(const Lanes& y) noexcept { return *this = *this - y; }
  Lanes& operator*=(const Lanes& y) noexcept { return *this = *this * y; }
  Lanes& operator/=(const Lanes& y) noexcept { return *this = *this / y; }

  // Always inlined: a call costs more than the operation.
  [[gnu::always_inline]] friend Lanes operator+(const Lanes& x, const Lanes& y) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return x.parts[i] + y.parts[i]; });
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& x, const Lanes& y) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return x.parts[i] - y.parts[i]; });
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes& x) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return -x.parts[i]; });
  }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes& x, const Lanes& y) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return x.parts[i] * y.parts[i]; });
  }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes& x, const Lanes& y) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return x.parts[i] / y.parts[i]; });
  }
  [[gnu::always_inline]] friend LaneMask<N> operator<(const Lanes& x, const Lanes& y) noexcept {
    return by_part<LaneMask<N>>([&](std::size_t i) { return x.parts[i] < y.parts[i]; });
  }
  [[gnu::always_inline]] friend LaneMask<N> operator>(const Lanes& x, const Lanes& y) noexcept { return y < x; }
  [[gnu::always_inline]] friend LaneMask<N> operator!=(const Lanes& x, const Lanes& y) noexcept {
    return by_part<LaneMask<N>>([&](std::size_t i) { return x.parts[i] != y.parts[i]; });
  }

  /// A result of which each part is `f(part)`.
  template <class Result, class F>
  [[gnu::always_inline]] static Result by_part(F&& f) noexcept {
    Result result;  // NOLINT(cppcoreguidelines-pro-type-member-init): every part is set
    for (std::size_t i = 0; i < kParts; ++i) {
      result.parts[i] = f(i);
    }
    return result;
  }

  /// A result of which each lane is `f(lane)`: numbers from several places, and functions of the C library.
  template <class F>
  [[gnu::always_inline]] static Lanes by_lane(F&& f) noexcept {
    return by_part<Lanes>([&](std::size_t i) {
      const int first = static_cast<int>(i) * vectors::kWidth;
#if defined(__AVX__)
      return vectors::Numbers{f(first), f(first + 1), f(first + 2), f(first + 3)};
#else
      return vectors::Numbers{f(first), f(first + 1)};
#endif
    });
  }

  friend Lanes sqrt(const Lanes& x) noexcept {
    return by_part<Lanes>([&](std::size_t i) { return vectors::root_of(x.parts[i]); });
  }
  friend Lanes exp(const Lanes& x) noexcept {
    return by_lane([&](int lane) { return std::exp(x[lane]); });
  }
  friend Lanes log(const Lanes& x) noexcept {
    return by_lane([&](int lane) { return std::log(x[lane]); });
  }
  friend Lanes sin(const Lanes& x) noexcept {
    return by_lane([&](int lane) { return std::sin(x[lane]); });
  }
  friend Lanes cos(const Lanes& x) noexcept {
    return by_lane([&](int lane) { return std::cos(x[lane]); });
  }
  friend Lanes pow(const Lanes& x, const Lanes& exponent) noexcept {
    return by_lane([&](int lane) { return std::pow(x[lane], exponent[lane]); });
  }

 private:
  [[gnu::always_inline]] void copy(const Lanes& other) noexcept {
    for (std::size_t i = 0; i < kParts; ++i) {
      parts[i] = other.parts[i];
    }
  }
};

template <int N>
const Lanes<N>& value_of(const Lanes<N>& x) noexcept {
  return x;
}

template <int N>
[[gnu::always_inline]] inline Lanes<N> select(const LaneMask<N>& condition, const Lanes<N>& where_true,
                                              const Lanes<N>& where_false) noexcept {
  return Lanes<N>::template by_part<Lanes<N>>(
      [&](std::size_t i) { return condition.parts[i] ? where_true.parts[i] : where_false.parts[i]; });
}

template <int N>
Lanes<N> one_where(const LaneMask<N>& condition) noexcept {
  return select(condition, Lanes<N>(1.0), Lanes<N>(0.0));
}

template <int N>
bool anywhere(const LaneMask<N>& condition) noexcept {
  int bits = 0;
  for (const vectors::Words& part : condition.parts) {
    bits |= vectors::bits_of(part);
  }
  return bits != 0;
}

template <int N>
bool everywhere(const LaneMask<N>& condition) noexcept {
  int bits = vectors::kAllBits;
  for (const vectors::Words& part : condition.parts) {
    bits &= vectors::bits_of(part);
  }
  return bits == vectors::kAllBits;
}

template <class S>
requires are_lanes<S> S sign_of(const S& x)
noexcept {
  const S one = select(x < S(0.0), S(-1.0), S(1.0));
  return select(x != S(0.0), one, S(0.0));
}

template <class S>
requires are_lanes<S> S clamp_symmetric(const S& x, const S& limit)
noexcept { return select(x > limit, limit, select(x < -limit, -limit, x)); }

/// The series of `plain_fading_exponential`, lane by lane the same bits.
template <class S>
requires are_lanes<S> S fading_exponential(const S& x)
noexcept {
  const S limited = select(x < S(kLongestFade), x, S(kLongestFade));
  const S shifted = limited * std::numbers::log2e + kWholeNumbers;
  return fading_series(limited, S(shifted - kWholeNumbers)) * S::template by_part<S>([&](std::size_t i) {
           const vectors::Bits bias = vectors::all(std::uint64_t{1023} << 52);
           return std::bit_cast<vectors::Numbers>(bias - (std::bit_cast<vectors::Bits>(shifted.parts[i]) << 52));
         });
}

/// The exact hold of each lane: the number of operations depends on its values.
template <class S, int States, int Inputs>
requires are_lanes<S> ExactHold<S, States, Inputs> exact_hold(const Eigen::Matrix<S, States, States>& a,
                                                              const Eigen::Matrix<S, States, Inputs>& b, double h) {
  ExactHold<S, States, Inputs> hold;
  for (int lane = 0; lane < S::kLanes; ++lane) {
    const auto plain = [lane](const S& x) { return x[lane]; };
    const Eigen::Matrix<double, States, States> own_a = a.unaryExpr(plain);
    const Eigen::Matrix<double, States, Inputs> own_b = b.unaryExpr(plain);
    const ExactHold<double, States, Inputs> own = model::exact_hold<double, States, Inputs>(own_a, own_b, h);
    for (Eigen::Index i = 0; i < own.transition.size(); ++i) {
      hold.transition.data()[i].set(lane, own.transition.data()[i]);
    }
    for (Eigen::Index i = 0; i < own.response.size(); ++i) {
      hold.response.data()[i].set(lane, own.response.data()[i]);
    }
  }
  return hold;
}

}  // namespace registers_of_four or registers_of_two

}  // namespace hotfire::model

namespace Eigen {

namespace internal {

/// A matrix of lanes has the alignment of its lanes, which may be more than Eigen's own.
template <int N, int Size>
struct compute_default_alignment<hotfire::model::Lanes<N>, Size> {
  enum { value = 0 };  // NOLINT(readability-identifier-naming): Eigen's name
};

}  // namespace internal

template <int N>
struct NumTraits<hotfire::model::Lanes<N>> : GenericNumTraits<double> {
  using Real = hotfire::model::Lanes<N>;
  using NonInteger = hotfire::model::Lanes<N>;
  using Nested = hotfire::model::Lanes<N>;
  using Literal = double;
};

}  // namespace Eigen
