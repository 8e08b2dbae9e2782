// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// x+ = transition x + response n: the exact solution of x' = A x + B n over one step with n held.
/// transition = e^{A h}, response = (integral of e^{A s} from 0 to h) B.
template <class S, int States, int Inputs>
struct ExactHold {
  Eigen::Matrix<S, States, States> transition;
  Eigen::Matrix<S, States, Inputs> response;
};

/// matrix * vector, written out: the fixed-size product that costs least in every scalar of the model.
template <class S, int Rows, int Columns>
Eigen::Matrix<S, Rows, 1> times(const Eigen::Matrix<S, Rows, Columns>& matrix,
                                const Eigen::Matrix<S, Columns, 1>& vector) noexcept {
  Eigen::Matrix<S, Rows, 1> result;
  for (int i = 0; i < Rows; ++i) {
    S sum = matrix(i, 0) * vector(0);
    for (int j = 1; j < Columns; ++j) {
      sum += matrix(i, j) * vector(j);
    }
    result(i) = sum;
  }
  return result;
}

/// left * right, written out: Eigen's product of matrices of this size takes a block of the heap.
template <class S, int N>
Eigen::Matrix<S, N, N> product(const Eigen::Matrix<S, N, N>& left, const Eigen::Matrix<S, N, N>& right) noexcept {
  Eigen::Matrix<S, N, N> result;
  for (int column = 0; column < N; ++column) {
    for (int row = 0; row < N; ++row) {
      S sum = left(row, 0) * right(0, column);
      for (int k = 1; k < N; ++k) {
        sum += left(row, k) * right(k, column);
      }
      result(row, column) = sum;
    }
  }
  return result;
}

/// e^M by balancing (Parlett and Reinsch 1969), scaling and squaring, and a Taylor series of degree 12: with the scaled norm
/// below 1/4 the remainder is below 1e-17 of the result [Moler and Van Loan 2003, Nineteen Dubious Ways, method 3].
/// Set-up only: the number of operations depends on the norm.
template <class S, int N>
Eigen::Matrix<S, N, N> matrix_exponential(Eigen::Matrix<S, N, N> matrix) {
  std::array<double, N> scale{};
  scale.fill(1.0);
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (int i = 0; i < N; ++i) {
      double row = 0.0;
      double column = 0.0;
      for (int j = 0; j < N; ++j) {
        if (j != i) {
          row += std::abs(value_of(matrix(i, j)));
          column += std::abs(value_of(matrix(j, i)));
        }
      }
      if (row > 0.0 && column > 0.0) {
        const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
        scale[static_cast<std::size_t>(i)] *= factor;
        for (int j = 0; j < N; ++j) {
          matrix(i, j) *= S(1.0 / factor);
          matrix(j, i) *= S(factor);
        }
      }
    }
  }
  double norm = 0.0;
  for (int i = 0; i < N; ++i) {
    double row = 0.0;
    for (int j = 0; j < N; ++j) {
      row += std::abs(value_of(matrix(i, j)));
    }
    norm = std::max(norm, row);
  }
  const int squarings = norm > 0.25 ? static_cast<int>(std::ceil(std::log2(norm / 0.25))) : 0;
  matrix *= S(std::exp2(-squarings));
  Eigen::Matrix<S, N, N> result = Eigen::Matrix<S, N, N>::Identity();
  for (int term = 12; term >= 1; --term) {
    Eigen::Matrix<S, N, N> next = product(matrix, result);
    next *= S(1.0 / term);
    result = next + Eigen::Matrix<S, N, N>::Identity();
  }
  for (int i = 0; i < squarings; ++i) {
    const Eigen::Matrix<S, N, N> squared = product(result, result);
    result = squared;
  }
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      result(i, j) *= S(scale[static_cast<std::size_t>(i)] / scale[static_cast<std::size_t>(j)]);
    }
  }
  return result;
}

/// The exact hold of x' = A x + B n over `h` [s], computed as a `Precise`: squaring in float would double its rounding error
/// a dozen times.
template <class S, int States, int Inputs>
ExactHold<S, States, Inputs> exact_hold(const Eigen::Matrix<S, States, States>& a, const Eigen::Matrix<S, States, Inputs>& b,
                                        double h) {
  using P = Precise<S>;
  using Block = Eigen::Matrix<P, States + Inputs, States + Inputs>;
  Block block = Block::Zero();
  block.template topLeftCorner<States, States>() = a.template cast<P>() * P(h);
  block.template topRightCorner<States, Inputs>() = b.template cast<P>() * P(h);
  const Block exponential = matrix_exponential<P, States + Inputs>(block);
  return {exponential.template topLeftCorner<States, States>().template cast<S>(),
          exponential.template topRightCorner<States, Inputs>().template cast<S>()};
}

}  // namespace hotfire::model
