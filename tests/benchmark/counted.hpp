// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>

namespace hotfire::test {

/// What a piece of arithmetic took, by kind.
struct Operations {
  long additions = 0;  ///< and subtractions and changes of sign
  long multiplications = 0;
  long divisions = 0;
  long roots = 0;
  long exponentials = 0;  ///< and other functions of the C library
  long comparisons = 0;
};

/// A number that counts what is done with it: the model runs in it as in any other scalar.
struct Counted {
  double a = 0.0;

  Counted() = default;
  template <class T>
  requires std::integral<T> || std::floating_point<T> Counted(T value)
      : a(static_cast<double>(value)) {}  // NOLINT(google-explicit-constructor): as a number converts

  inline static Operations operations{};

  Counted& operator+=(const Counted& y) { return *this = *this + y; }
  Counted& operator-=(const Counted& y) { return *this = *this - y; }
  Counted& operator*=(const Counted& y) { return *this = *this * y; }
  Counted& operator/=(const Counted& y) { return *this = *this / y; }

  friend Counted operator+(const Counted& x, const Counted& y) { return counted(operations.additions, x.a + y.a); }
  friend Counted operator-(const Counted& x, const Counted& y) { return counted(operations.additions, x.a - y.a); }
  friend Counted operator-(const Counted& x) { return counted(operations.additions, -x.a); }
  friend Counted operator*(const Counted& x, const Counted& y) { return counted(operations.multiplications, x.a * y.a); }
  friend Counted operator/(const Counted& x, const Counted& y) { return counted(operations.divisions, x.a / y.a); }
  friend bool operator<(const Counted& x, const Counted& y) { return ++operations.comparisons, x.a < y.a; }
  friend bool operator>(const Counted& x, const Counted& y) { return ++operations.comparisons, x.a > y.a; }
  friend bool operator<=(const Counted& x, const Counted& y) { return ++operations.comparisons, x.a <= y.a; }
  friend bool operator>=(const Counted& x, const Counted& y) { return ++operations.comparisons, x.a >= y.a; }
  friend bool operator==(const Counted& x, const Counted& y) { return ++operations.comparisons, x.a == y.a; }

  friend Counted sqrt(const Counted& x) { return counted(operations.roots, std::sqrt(x.a)); }
  friend Counted abs(const Counted& x) { return counted(operations.additions, std::abs(x.a)); }
  friend Counted exp(const Counted& x) { return counted(operations.exponentials, std::exp(x.a)); }
  friend Counted expm1(const Counted& x) { return counted(operations.exponentials, std::expm1(x.a)); }
  friend Counted log(const Counted& x) { return counted(operations.exponentials, std::log(x.a)); }
  friend Counted pow(const Counted& x, const Counted& y) { return counted(operations.exponentials, std::pow(x.a, y.a)); }
  friend Counted sin(const Counted& x) { return counted(operations.exponentials, std::sin(x.a)); }
  friend Counted cos(const Counted& x) { return counted(operations.exponentials, std::cos(x.a)); }
  friend Counted tanh(const Counted& x) { return counted(operations.exponentials, std::tanh(x.a)); }
  friend Counted floor(const Counted& x) { return counted(operations.additions, std::floor(x.a)); }
  /// The model's own e^-x, as one function.
  template <class S>
  friend S fading_exponential(const Counted& x) {
    return counted(operations.exponentials, std::exp(-x.a));
  }

 private:
  static Counted counted(long& kind, double value) {
    ++kind;
    return {value};
  }
};

}  // namespace hotfire::test

namespace Eigen {
template <>
struct NumTraits<hotfire::test::Counted> : GenericNumTraits<double> {
  using Real = hotfire::test::Counted;
  using NonInteger = hotfire::test::Counted;
  using Nested = hotfire::test::Counted;
  using Literal = double;
};
}  // namespace Eigen
