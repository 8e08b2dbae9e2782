// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// True if the matrix equals its transpose to `kSymmetry` of its own scale, row by row and column by column.
template <class S, int N>
bool is_symmetric(const Eigen::Matrix<S, N, N>& matrix) {
  constexpr double kSymmetry = 1e-9;  // what a matrix printed with ten digits keeps
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < i; ++j) {
      const double scale = std::sqrt(std::abs(value_of(matrix(i, i)) * value_of(matrix(j, j))));
      if (!(std::abs(value_of(matrix(i, j)) - value_of(matrix(j, i))) <= kSymmetry * scale)) {
        return false;
      }
    }
  }
  return true;
}

/// The factor L of matrix = L L^T (Cholesky), of which only the lower triangle is read. Returns false, with the factor
/// unfinished, if the matrix is not positive definite. Written out because Eigen's order of additions follows
/// the instruction set, and a model must have the same bits in the host's tools and on the target.
template <class S, int N>
bool factorise(const Eigen::Matrix<S, N, N>& matrix, Eigen::Matrix<S, N, N>& factor) noexcept {
  factor.setZero();
  // Unrolled, factorisation and solution take half of the instructions. The order of operations does not change.
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    S pivot = matrix(j, j);
#pragma GCC unroll 16
    for (int k = 0; k < j; ++k) {
      pivot -= factor(j, k) * factor(j, k);
    }
    if (!everywhere(value_of(pivot) > 0.0)) {
      return false;
    }
    factor(j, j) = sqrt(pivot);
#pragma GCC unroll 16
    for (int i = j + 1; i < N; ++i) {
      S sum = matrix(i, j);
#pragma GCC unroll 16
      for (int k = 0; k < j; ++k) {
        sum -= factor(i, k) * factor(j, k);
      }
      factor(i, j) = sum / factor(j, j);
    }
  }
  return true;
}

template <class S, int N>
bool is_positive_definite(const Eigen::Matrix<S, N, N>& matrix) {
  Eigen::Matrix<S, N, N> factor;
  return factorise<S, N>(matrix, factor);
}

/// Solves L L^T x = b with a finished factor L.
template <class S, int N>
Eigen::Matrix<S, N, 1> solve_factorised(const Eigen::Matrix<S, N, N>& factor, const Eigen::Matrix<S, N, 1>& b) noexcept {
  Eigen::Matrix<S, N, 1> x;
#pragma GCC unroll 16
  for (int i = 0; i < N; ++i) {
    S sum = b(i);
#pragma GCC unroll 16
    for (int k = 0; k < i; ++k) {
      sum -= factor(i, k) * x(k);
    }
    x(i) = sum / factor(i, i);
  }
#pragma GCC unroll 16
  for (int i = N - 1; i >= 0; --i) {
    S sum = x(i);
#pragma GCC unroll 16
    for (int k = i + 1; k < N; ++k) {
      sum -= factor(k, i) * x(k);
    }
    x(i) = sum / factor(i, i);
  }
  return x;
}

/// Eigenvalues of a symmetric matrix, and its orthonormal eigenvectors as columns.
template <class S, int N>
struct Eigensystem {
  Eigen::Matrix<S, N, 1> values;
  Eigen::Matrix<S, N, N> vectors;
};

/// The eigensystem of a symmetric positive definite matrix by cyclic Jacobi rotations [Golub and Van Loan 2013, Matrix
/// Computations, section 8.5]. Small eigenvalues have the relative accuracy of large ones [Demmel and Veselic 1992, SIAM J.
/// Matrix Anal. Appl. 13]. Set-up only. Written out for the reason of `factorise`.
template <class S, int N>
Eigensystem<S, N> eigensystem_of_symmetric(Eigen::Matrix<S, N, N> matrix) {
  constexpr int kSweeps = 15;         // from the fourth or so on each squares what is left beside the diagonal
  constexpr double kNothing = 1e-17;  // beside the diagonal, over its entries: below the rounding of either
  Eigensystem<S, N> system;
  system.vectors.setIdentity();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < N; ++p) {
      for (int q = p + 1; q < N; ++q) {
        const double scale = std::sqrt(value_of(matrix(p, p)) * value_of(matrix(q, q)));
        if (!(std::abs(value_of(matrix(p, q))) > kNothing * scale)) {
          continue;
        }
        const S half_gap = 0.5 * (matrix(q, q) - matrix(p, p));
        const S length = sqrt(half_gap * half_gap + matrix(p, q) * matrix(p, q));
        const S tangent = matrix(p, q) / (value_of(half_gap) < 0.0 ? S(half_gap - length) : S(half_gap + length));
        const S cosine = 1.0 / sqrt(1.0 + tangent * tangent);
        const S sine = tangent * cosine;
        const auto rotate = [&](S& first, S& second) {
          const S before = first;
          first = cosine * before - sine * second;
          second = sine * before + cosine * second;
        };
        for (int k = 0; k < N; ++k) {
          rotate(matrix(k, p), matrix(k, q));
        }
        for (int k = 0; k < N; ++k) {
          rotate(matrix(p, k), matrix(q, k));
          rotate(system.vectors(k, p), system.vectors(k, q));
        }
      }
    }
  }
  system.values = matrix.diagonal();
  return system;
}

/// Inverse of a symmetric positive definite matrix. Set-up only; zero if the matrix is not what it must be.
template <class S, int N>
Eigen::Matrix<S, N, N> inverse_of_positive_definite(const Eigen::Matrix<S, N, N>& matrix) {
  Eigen::Matrix<S, N, N> factor;
  Eigen::Matrix<S, N, N> inverse = Eigen::Matrix<S, N, N>::Zero();
  if (!factorise<S, N>(matrix, factor)) {
    return inverse;
  }
  for (int column = 0; column < N; ++column) {
    Eigen::Matrix<S, N, 1> unit = Eigen::Matrix<S, N, 1>::Zero();
    unit(column) = S(1.0);
    inverse.col(column) = solve_factorised<S, N>(factor, unit);
  }
  return inverse;
}

}  // namespace hotfire::model
