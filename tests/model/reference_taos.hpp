#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "tools/study/reference_axis.hpp"

namespace hotfire::test {

using study::ReferenceAxis;

/// One engine with two hydraulic axes on a compliant bearing and a modal structure, written from physics.md sections 1 to 3
/// alone, by vector mechanics: what the model is judged by. Nothing of model/ is used here.
struct ReferenceTaos {
  using Vector = Eigen::Vector3d;

  std::array<ReferenceAxis, 2> axes;  ///< pitch, yaw: declared values, dead band, softness and sine of nothing else
  std::array<Vector, 2> on_engine;    ///< attach points at zero angles, from the gimbal's centre
  std::array<Vector, 2> on_vehicle;
  double thrust = 0.0;
  double loss_time = 1e-3;
  Eigen::Matrix<double, 6, 6> bearing_compliance = Eigen::Matrix<double, 6, 6>::Zero();
  ReferenceAxis::Bristle friction;  ///< one bristle vector over both angles; level zero: none
  double vibration_ratio = 1.0;
  double vibration_velocity = 1.0;

  struct Mode {
    double frequency = 0.0;  ///< [Hz]
    double damping = 0.0;
    std::array<double, 2> attach{};
    std::array<double, 2> rotation{};
  };
  std::vector<Mode> modes;

  /// Where a run starts: the eight states of both axes, six displacements of the bearing, the modes.
  struct Start {
    std::array<std::array<double, 8>, 2> axes{};
    std::array<double, 6> bearing{};
    std::vector<double> modes;
  };
};

/// Piston and engine of pitch, then of yaw, at the end of each sample of `sample` seconds, the commands [rad] held between
/// samples. As `integrate_reference`.
std::vector<std::array<double, 4>> integrate_reference(const ReferenceTaos& taos, const ReferenceTaos::Start& start,
                                                       const std::vector<std::array<double, 2>>& commands, double sample,
                                                       double tolerance = 1e-10);

}  // namespace hotfire::test
