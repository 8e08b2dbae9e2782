// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

#include "model/numerics/lanes.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

// In the namespaces of the lanes, for their reason.
#if defined(__AVX__)
inline namespace registers_of_four {
#else
inline namespace registers_of_two {
#endif

/// A number side by side with what it becomes under `N - 1` small changes of the parameters: a scalar in which one run of
/// the model gives `N - 1` difference quotients. An operation is one of a register, so that a difference quotient costs two
/// thirds of a derivative by dual numbers.
///
/// The number itself, lane 0, has the bits of a run in double, and every choice is made by it: a branch, a whole part, a
/// piece of a table. A difference is then one along the branches of the number, as a derivative is, however close a choice
/// was. A change that leaves the domain of a function on its branch goes along the tangent at the number: one to a divisor
/// of zero, or to a negative number under a root.
template <int N>
class Perturbed {
 public:
  static constexpr int kChanges = N - 1;

  Perturbed() = default;
  template <class T>
  // NOLINTNEXTLINE(google-explicit-constructor): as a number converts
  requires std::is_arithmetic_v<T> Perturbed(T value)
  noexcept : lanes_(value) {}

  double value() const noexcept { return lanes_[0]; }
  /// Under a change, from 0 on.
  double changed(int change) const noexcept { return lanes_[change + 1]; }
  void set_changed(int change, double value) noexcept { lanes_.set(change + 1, value); }

  // Always inlined: a call costs more than the operation.
  [[gnu::always_inline]] Perturbed& operator+=(const Perturbed& y) noexcept { return *this = *this + y; }
  [[gnu::always_inline]] Perturbed& operator-=(const Perturbed& y) noexcept { return *this = *this - y; }
  [[gnu::always_inline]] Perturbed& operator*=(const Perturbed& y) noexcept { return *this = *this * y; }
  [[gnu::always_inline]] Perturbed& operator/=(const Perturbed& y) noexcept { return *this = *this / y; }

  [[gnu::always_inline]] friend Perturbed operator+(const Perturbed& x, const Perturbed& y) noexcept {
    return Perturbed(x.lanes_ + y.lanes_);
  }
  [[gnu::always_inline]] friend Perturbed operator-(const Perturbed& x, const Perturbed& y) noexcept {
    return Perturbed(x.lanes_ - y.lanes_);
  }
  [[gnu::always_inline]] friend Perturbed operator*(const Perturbed& x, const Perturbed& y) noexcept {
    return Perturbed(x.lanes_ * y.lanes_);
  }
  [[gnu::always_inline]] friend Perturbed operator/(const Perturbed& x, const Perturbed& y) noexcept {
    return Perturbed(x.lanes_ / y.lanes_).or_along_tangent([&](int lane, double quotient) {
      return (x.lanes_[lane] - quotient * y.lanes_[lane]) / y.value();
    });
  }
  [[gnu::always_inline]] friend Perturbed operator-(const Perturbed& x) noexcept { return Perturbed(-x.lanes_); }

  friend bool operator<(const Perturbed& x, const Perturbed& y) noexcept { return x.value() < y.value(); }
  friend bool operator>(const Perturbed& x, const Perturbed& y) noexcept { return x.value() > y.value(); }
  friend bool operator<=(const Perturbed& x, const Perturbed& y) noexcept { return x.value() <= y.value(); }
  friend bool operator>=(const Perturbed& x, const Perturbed& y) noexcept { return x.value() >= y.value(); }
  friend bool operator==(const Perturbed& x, const Perturbed& y) noexcept { return x.value() == y.value(); }
  friend bool operator!=(const Perturbed& x, const Perturbed& y) noexcept { return x.value() != y.value(); }

  friend Perturbed abs(const Perturbed& x) noexcept { return x.value() < 0.0 ? -x : x; }
  friend Perturbed floor(const Perturbed& x) noexcept { return Perturbed(std::floor(x.value())); }
  friend Perturbed sqrt(const Perturbed& x) noexcept {
    return Perturbed(sqrt(x.lanes_)).or_along_tangent([&](int lane, double root) {
      return 0.5 * (x.lanes_[lane] - x.value()) / root;
    });
  }
  friend Perturbed exp(const Perturbed& x) noexcept { return Perturbed(exp(x.lanes_)); }
  friend Perturbed log(const Perturbed& x) noexcept {
    const double at = x.value();
    return x.by_lane([at](double lane) { return lane > 0.0 ? std::log(lane) : std::log(at) + lane / at - 1.0; });
  }
  friend Perturbed sin(const Perturbed& x) noexcept {
    return x.by_lane([](double lane) { return std::sin(lane); });
  }
  friend Perturbed cos(const Perturbed& x) noexcept {
    return x.by_lane([](double lane) { return std::cos(lane); });
  }
  friend Perturbed expm1(const Perturbed& x) noexcept {
    return x.by_lane([](double lane) { return std::expm1(lane); });
  }
  friend Perturbed pow(const Perturbed& x, const Perturbed& y) noexcept {
    const auto powers = Lanes<N>::by_lane([&](int lane) { return std::pow(x.lanes_[lane], y.lanes_[lane]); });
    return Perturbed(powers).or_along_tangent(
        [&](int lane, double power) { return y.value() * power * (x.lanes_[lane] / x.value() - 1.0); });
  }
  /// e^-x.
  Perturbed faded() const noexcept { return Perturbed(fading_exponential(lanes_)); }

 private:
  explicit Perturbed(const Lanes<N>& lanes) noexcept : lanes_(lanes) {}

  template <class F>
  Perturbed by_lane(F&& f) const noexcept {
    return Perturbed(Lanes<N>::by_lane([&](int lane) { return f(lanes_[lane]); }));
  }

  /// This result, with `change(lane, number)` added to the number where a change has no finite result.
  template <class Change>
  [[gnu::always_inline]] Perturbed or_along_tangent(const Change& change) const noexcept {
    return everywhere(lanes_ - lanes_ < Lanes<N>(1.0)) ? *this : along_tangent(change);
  }
  template <class Change>
  [[gnu::noinline, gnu::cold]] Perturbed along_tangent(const Change& change) const noexcept {
    const double number = value();
    return Perturbed(Lanes<N>::by_lane([&](int lane) {
      return std::isfinite(lanes_[lane]) || !std::isfinite(number) ? lanes_[lane] : number + change(lane, number);
    }));
  }

  Lanes<N> lanes_;
};

template <int N>
double value_of(const Perturbed<N>& x) noexcept {
  return x.value();
}

template <class S>
requires requires(const S& x) { x.faded(); }
S fading_exponential(const S& x) noexcept { return x.faded(); }

}  // namespace registers_of_four or registers_of_two

}  // namespace hotfire::model

namespace Eigen {

namespace internal {

/// A matrix of them has their alignment, which may be more than Eigen's own.
template <int N, int Size>
struct compute_default_alignment<hotfire::model::Perturbed<N>, Size> {
  enum { value = 0 };  // NOLINT(readability-identifier-naming): Eigen's name
};

}  // namespace internal

template <int N>
struct NumTraits<hotfire::model::Perturbed<N>> : GenericNumTraits<double> {
  using Real = hotfire::model::Perturbed<N>;
  using NonInteger = hotfire::model::Perturbed<N>;
  using Nested = hotfire::model::Perturbed<N>;
  using Literal = double;
};

}  // namespace Eigen
