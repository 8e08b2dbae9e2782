// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>

namespace hotfire::test {

// Fixed-step solvers of x' = f(x), as toolchains of real-time simulation have them: what the model's own step is compared
// with. `System` has `size`, `Vector<S>`, `derivative(x, rate)` and `jacobian(x, matrix)`.

template <class System>
using PointOf = typename System::template Vector<double>;
template <class System>
using JacobianOf = Eigen::Matrix<double, System::size, System::size>;

/// The classical method of fourth order [Kutta 1901].
struct RungeKutta {
  template <class System>
  static void step(const System& system, double h, PointOf<System>& x) noexcept {
    PointOf<System> k1;
    PointOf<System> k2;
    PointOf<System> k3;
    PointOf<System> k4;
    system.derivative(x, k1);
    system.derivative(x + 0.5 * h * k1, k2);
    system.derivative(x + 0.5 * h * k2, k3);
    system.derivative(x + h * k3, k4);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
};

/// Linearly implicit Euler steps h, h/2 ... h/Order, extrapolated to order `Order` by Aitken and Neville, with the Jacobian
/// of the start of the step [Deuflhard 1985, SIAM Review 27, sec. 3.2].
template <int Order>
struct Extrapolation {
  template <class System>
  static void step(const System& system, double h, PointOf<System>& x) noexcept {
    JacobianOf<System> jacobian;
    system.jacobian(x, jacobian);
    std::array<PointOf<System>, Order> table;
    PointOf<System> rate;
    for (int j = 0; j < Order; ++j) {
      const int parts = j + 1;
      const double part = h / parts;
      const Eigen::PartialPivLU<JacobianOf<System>> solver(JacobianOf<System>::Identity() - part * jacobian);
      auto& own = table[static_cast<std::size_t>(j)];
      own = x;
      for (int i = 0; i < parts; ++i) {
        system.derivative(own, rate);
        own += solver.solve(part * rate);
      }
      for (int k = j - 1; k >= 0; --k) {
        auto& less = table[static_cast<std::size_t>(k)];
        less = table[static_cast<std::size_t>(k + 1)] +
               (table[static_cast<std::size_t>(k + 1)] - less) / (static_cast<double>(parts) / (k + 1) - 1.0);
      }
    }
    x = table[0];
  }
};

/// The implicit midpoint rule with a fixed number of Newton steps, with the Jacobian of the start of the step.
template <int Iterations>
struct ImplicitMidpoint {
  template <class System>
  static void step(const System& system, double h, PointOf<System>& x) noexcept {
    JacobianOf<System> jacobian;
    system.jacobian(x, jacobian);
    const Eigen::PartialPivLU<JacobianOf<System>> solver(JacobianOf<System>::Identity() - 0.5 * h * jacobian);
    PointOf<System> change = PointOf<System>::Zero();
    PointOf<System> rate;
    for (int i = 0; i < Iterations; ++i) {
      system.derivative(x + 0.5 * change, rate);
      change -= solver.solve(change - h * rate);
    }
    x += change;
  }
};

}  // namespace hotfire::test
