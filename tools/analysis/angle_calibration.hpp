// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace hotfire::analysis {

/// Lengths of an engine's four strings [m] while it is held at known angles [rad].
struct SettledAngles {
  std::array<double, 4> lengths{};
  double pitch = 0.0;
  double yaw = 0.0;
};

/// The affine transform from four string lengths to two angles [SD 2.3], fitted by least squares to angles that were
/// commanded and had settled.
class AngleCalibration {
 public:
  /// Needs at least five settled poses that turn about both angles; throws std::invalid_argument otherwise.
  explicit AngleCalibration(std::span<const SettledAngles> settled);

  /// Pitch and yaw [rad].
  std::array<double, 2> angles(const std::array<double, 4>& lengths) const;

  /// Rms over the settled poses of what the transform leaves, pitch and yaw together [rad].
  double residual() const { return residual_; }

 private:
  Eigen::Matrix<double, 2, 5> transform_;
  double residual_ = 0.0;
};

}  // namespace hotfire::analysis
