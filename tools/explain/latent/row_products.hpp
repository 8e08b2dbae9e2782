// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace hotfire::explain {

/// Sums over rows of the products of some values among themselves (`own`), and with other values of the same row (`cross`).
/// A matrix product of many rows takes a fraction of the time of as many outer products. Values in single precision are
/// multiplied in it, and their products are summed in double.
template <class Scalar = double>
class RowProducts {
 public:
  explicit RowProducts(Eigen::Index values, Eigen::Index others = 0)
      : own(Eigen::MatrixXd::Zero(values, values)),
        cross(Eigen::MatrixXd::Zero(values, others)),
        values_(values, kTogether),
        others_(others, kTogether) {}

  /// One row: `set(values, others)` writes them into two columns.
  template <class Set>
  void add(Set&& set) {
    set(values_.col(rows_), others_.col(rows_));
    if (++rows_ == kTogether) {
      flush();
    }
  }

  /// Adds the rows that wait. To be called before the sums are read.
  void flush() {
    const auto values = values_.leftCols(rows_);
    const auto add = [](Eigen::MatrixXd& sum, auto&& product) {
      if constexpr (std::is_same_v<Scalar, double>) {
        sum.noalias() += product;
      } else {
        sum += Matrix(product).template cast<double>();
      }
    };
    add(own, values * values.transpose());
    add(cross, values * others_.leftCols(rows_).transpose());
    rows_ = 0;
  }

  Eigen::MatrixXd own;    ///< a row and a column a value
  Eigen::MatrixXd cross;  ///< a row a value, a column one of the others

 private:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  /// Rows that are multiplied together: enough for a matrix product, few enough for the first cache.
  static constexpr Eigen::Index kTogether = 64;

  Matrix values_;
  Matrix others_;
  Eigen::Index rows_ = 0;
};

}  // namespace hotfire::explain
