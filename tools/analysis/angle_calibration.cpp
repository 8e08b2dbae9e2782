// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/angle_calibration.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace hotfire::analysis {

namespace {

Eigen::Matrix<double, 1, 5> row_of(const std::array<double, 4>& lengths) {
  Eigen::Matrix<double, 1, 5> row;
  row << 1.0, lengths[0], lengths[1], lengths[2], lengths[3];
  return row;
}

}  // namespace

AngleCalibration::AngleCalibration(std::span<const SettledAngles> settled) {
  const auto count = static_cast<Eigen::Index>(settled.size());
  Eigen::MatrixXd lengths(count, 5);
  Eigen::MatrixXd angles(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    const SettledAngles& own = settled[static_cast<std::size_t>(k)];
    lengths.row(k) = row_of(own.lengths);
    angles.row(k) << own.pitch, own.yaw;
  }
  if (count < 5 || !(angles.col(0).maxCoeff() > angles.col(0).minCoeff()) ||
      !(angles.col(1).maxCoeff() > angles.col(1).minCoeff())) {
    throw std::invalid_argument("a calibration needs at least five settled poses that turn about both angles");
  }
  // Two strings on one line across the engine measure nearly the same: the least solution divides between them.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-9);
  solver.compute(lengths);
  transform_ = solver.solve(angles).transpose();
  residual_ = (lengths * transform_.transpose() - angles).norm() / std::sqrt(2.0 * static_cast<double>(count));
}

std::array<double, 2> AngleCalibration::angles(const std::array<double, 4>& lengths) const {
  const Eigen::Vector2d both = transform_ * row_of(lengths).transpose();
  return {both(0), both(1)};
}

}  // namespace hotfire::analysis
