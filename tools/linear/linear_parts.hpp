// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tools/linear/plant/plant.hpp"
#include "tools/linear/reduction.hpp"

namespace hotfire::linear {

/// How an axis moves, as rows of a matrix: its eight continuous states, the slip of its bearing, its attach point.
enum MotionRow { kSlipRow = 8, kAttachRow, kMotionRows };

/// What the linear parts of a plant do under a sine of its commands and of its ports: complex gains of one frequency.
struct Answer {
  Eigen::MatrixXcd motion_by_command;  ///< `kMotionRows` rows an axis; a column an axis
  Eigen::MatrixXcd motion_by_port;     ///< a column a port
  Eigen::MatrixXcd output_by_command;
  Eigen::MatrixXcd output_by_port;
};

/// The linear parts of a plant, with the ports through which its nonlinear laws act on them.
class LinearParts {
 public:
  /// The plant must live as long. Throws what `reduced` throws.
  explicit LinearParts(const Plant& plant) : LinearParts(plant, plant.map(With::linear_parts)) {}
  LinearParts(const Plant& plant, StepMap map);

  const StepMap& map() const { return map_; }
  const ReducedMap& reduced_map() const { return reduced_; }

  /// Axis and port of every law.
  const std::vector<std::array<int, 2>>& ports() const { return ports_; }

  /// What a unit of every port does to the kept states over a step, to the outputs at its end, to the load forces over it.
  const Eigen::MatrixXd& port_columns() const { return port_columns_; }
  Eigen::MatrixXd outputs_by_port() const { return by_port(map_.output_by_state, map_.output_by_input); }
  Eigen::MatrixXd forces_by_port() const { return by_port(force_by_state_, force_by_input_); }

  Answer answer_at(double frequency) const;

  /// Motion under constant port signals: `kMotionRows` rows an axis, a column a port.
  Eigen::MatrixXd motion_at_rest() const;

 private:
  /// The column of the inputs that is a port: that of the bearing is the velocity of its slip from outside.
  Eigen::Index input_of(std::size_t port) const;
  Eigen::MatrixXd by_port(const Eigen::MatrixXd& by_state, const Eigen::MatrixXd& by_input) const;
  template <class Matrix>
  Matrix motion(const Matrix& states, const Matrix& force, double smoothing) const;

  const Plant& plant_;
  StepMap map_;
  ReducedMap reduced_;
  std::vector<std::array<int, 2>> ports_{};
  Eigen::MatrixXd force_by_state_{};  ///< load forces over the step, a row an axis
  Eigen::MatrixXd force_by_input_{};
  std::vector<Eigen::Index> vibrations_{};  ///< of an axis: place of that input
  Eigen::MatrixXd port_columns_{};          ///< of the reduced map, a column a port
  Eigen::MatrixXd port_through_{};          ///< of all states, a column a port
};

}  // namespace hotfire::linear
