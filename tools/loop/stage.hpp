// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "tools/loop/controller.hpp"
#include "tools/structure/mode_table.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::loop {

/// The attitude of a stage in flight, which the side force of turned thrust moves:
///   q'' + 2 zeta w q' + w^2 q = sum over the axes of side thrust beta,    attitude = sum over the modes of sensor q
/// for every mode of its table that the sensor sees, those of the rigid body (w = 0) among them. beta is the angle of an
/// engine against the stage [rad]; each mode is advanced exactly under its mean over a step.
class Stage {
 public:
  /// `channel` is "pitch" or "yaw": what the sensor reads. Throws UsageError for a table without side forces, without a
  /// sensor or without a mode of the rigid body.
  Stage(const MasvParameters& vehicle, const FlightModes& modes, const std::string& channel);

  int axes() const { return static_cast<int>(force_.rows()); }
  int modes() const { return static_cast<int>(frequency_.size()); }

  /// What a sine of every engine angle does to attitude [rad/rad] and rate [1/s]: two rows, a column an axis.
  Eigen::MatrixXcd response(double frequency) const;

  /// A step of `h` [s] in state space: x = position and rate of mode after mode.
  struct Step {
    Eigen::MatrixXd by_state;
    Eigen::MatrixXd by_angle;  ///< of the mean angle of every engine over the step; a column an axis
    Eigen::MatrixXd read;      ///< attitude and rate; two rows
  };
  Step step(double h) const;

  /// A state at rest that is turned by `attitude` [rad] as a rigid body.
  Eigen::VectorXd turned(double attitude) const;

 private:
  Eigen::VectorXd frequency_;  ///< [Hz]
  Eigen::VectorXd damping_ratio_;
  Eigen::MatrixXd force_;  ///< per angle: a row an axis, a column a mode [N kg^-0.5]
  Eigen::VectorXd sensor_;
};

/// Name of axis `i` of a vehicle of four engines: "pitch1", "yaw1", ...
std::string axis_name(int i);

}  // namespace hotfire::loop
