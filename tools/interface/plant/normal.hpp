// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <random>

namespace hotfire {

/// Numbers of a normal distribution, mean 0, variance 1 [Box and Muller 1958, Ann. Math. Stat. 29]: the same on every
/// machine, as the standard library's distributions are not.
class Normal {
 public:
  explicit Normal(unsigned seed) : random_(seed) {}

  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }

  std::mt19937 random_;
};

}  // namespace hotfire
