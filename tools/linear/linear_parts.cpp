// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/linear_parts.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

}  // namespace

LinearParts::LinearParts(const Plant& plant, StepMap map) : plant_(plant), map_(std::move(map)), reduced_(reduced(map_)) {
  for (int axis = 0; axis < plant_.axes(); ++axis) {
    const auto used = plant_.in_use(axis);
    for (int port = 0; port < kAxisPorts; ++port) {
      if (used[static_cast<std::size_t>(port)]) {
        ports_.push_back({axis, port});
      }
    }
  }
  const std::vector<Index> rows(map_.load_force.begin(), map_.load_force.end());
  force_by_state_ = map_.by_state(rows, Eigen::all);
  force_by_input_ = map_.by_input(rows, Eigen::all);
  const auto kept = static_cast<Index>(reduced_.kept.size());
  const auto ports = static_cast<Index>(ports_.size());
  for (std::size_t i = 0; i < map_.inputs.size(); ++i) {
    if (map_.inputs[i].name.starts_with("vibration.")) {
      vibrations_.push_back(static_cast<Index>(i));
    }
  }
  port_columns_ = MatrixXd::Zero(kept, ports);
  port_through_ = MatrixXd::Zero(reduced_.of_kept.rows(), ports);
  for (Index k = 0; k < ports; ++k) {
    const Index column = input_of(static_cast<std::size_t>(k));
    port_columns_.col(k) = reduced_.b.col(column);
    port_through_.col(k) = reduced_.of_input.col(column);
  }
}

Index LinearParts::input_of(std::size_t port) const {
  const auto [axis, own] = ports_[port];
  return own == kFrictionPort ? vibrations_[static_cast<std::size_t>(axis)] : map_.port_column(axis, own);
}

MatrixXd LinearParts::by_port(const MatrixXd& by_state, const MatrixXd& by_input) const {
  MatrixXd all = by_state * port_through_;
  for (std::size_t k = 0; k < ports_.size(); ++k) {
    all.col(static_cast<Index>(k)) += by_input.col(input_of(k));
  }
  return all;
}

/// The rows of every axis, of all states and of the mean force of its load spring over a step. The attach point is where the
/// deflection is that the force does not account for.
template <class Matrix>
Matrix LinearParts::motion(const Matrix& states, const Matrix& force, double smoothing) const {
  Matrix rows = Matrix::Zero(kMotionRows * plant_.axes(), states.cols());
  for (int axis = 0; axis < plant_.axes(); ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const Index first = Index{kMotionRows} * axis;
    rows.middleRows(first, 8) = states.middleRows(map_.first[i], 8);
    if (map_.bristle[i] >= 0) {
      rows.row(first + kSlipRow) = states.row(map_.bristle[i]);
    }
    rows.row(first + kAttachRow) = smoothing * (rows.row(first + model::AxisStates::kPiston) -
                                                plant_.moment_arm(axis) * rows.row(first + model::AxisStates::kAngle)) -
                                   force.row(axis) / plant_.stiffness(axis);
  }
  return rows;
}

Answer LinearParts::answer_at(double frequency) const {
  const double angle = 2.0 * std::numbers::pi * frequency * map_.step;
  const Complex turn = std::polar(1.0, angle);
  // What is held over a step is a sine's value at its middle.
  const Complex half_turn = std::polar(1.0, 0.5 * angle);
  const double smoothing = std::cos(0.5 * angle);  // of a mean of both ends of a step
  const auto kept = static_cast<Index>(reduced_.kept.size());
  const auto axes = static_cast<Index>(plant_.axes());
  const Eigen::PartialPivLU<MatrixXcd> dynamics(turn * MatrixXcd::Identity(kept, kept) - reduced_.a.cast<Complex>());
  const MatrixXcd of_kept = reduced_.of_kept.cast<Complex>();
  const MatrixXd commands = reduced_.b.leftCols(axes);
  const MatrixXcd by_command =
      of_kept * dynamics.solve(commands.cast<Complex>()) + reduced_.of_input.leftCols(axes).cast<Complex>();
  const MatrixXcd kept_by_port = of_kept * dynamics.solve(port_columns_.cast<Complex>());
  const MatrixXcd states_by_port = kept_by_port + port_through_.cast<Complex>();
  const MatrixXcd force_by_command = force_by_state_ * by_command + force_by_input_.leftCols(axes);
  const MatrixXcd force_by_port = force_by_state_ * kept_by_port + forces_by_port();
  Answer answer;
  answer.motion_by_command = motion(MatrixXcd(by_command * half_turn), force_by_command, smoothing);
  answer.motion_by_port = motion(MatrixXcd(states_by_port * half_turn), force_by_port, smoothing);
  const Complex to_end = half_turn / turn;
  answer.output_by_command = (map_.output_by_state * by_command + map_.output_by_input.leftCols(axes)) * to_end;
  answer.output_by_port = (map_.output_by_state * kept_by_port + outputs_by_port()) * to_end;
  for (std::size_t k = 0; k < ports_.size(); ++k) {
    const auto [axis, port] = ports_[k];
    const auto column = static_cast<Index>(k);
    const Index first = Index{kMotionRows} * axis;
    if (port == kSpringPort) {
      answer.motion_by_port(first + kAttachRow, column) += 1.0;
    }
    if (port == kFrictionPort) {
      // Slip that the bearing's spring does not take up: over a step its mean velocity, against the sense of a vibration.
      const Complex velocity(0.0, -2.0 * std::sin(0.5 * angle) / map_.step);
      answer.motion_by_port.col(column) *= velocity;
      answer.output_by_port.col(column) *= velocity;
      answer.motion_by_port(first + kSlipRow, column) += 1.0;
    }
  }
  return answer;
}

MatrixXd LinearParts::motion_at_rest() const {
  // At rest, but for the springs of the bearings: the mean of such a port is what they are deflected by.
  std::vector<Index> resting;
  std::vector<Index> springs;
  for (std::size_t i = 0; i < reduced_.kept.size(); ++i) {
    const bool is_spring = std::find(map_.bristle.begin(), map_.bristle.end(), reduced_.kept[i]) != map_.bristle.end();
    (is_spring ? springs : resting).push_back(static_cast<Index>(i));
  }
  const auto count = static_cast<Index>(resting.size());
  const auto ports = static_cast<Index>(ports_.size());
  MatrixXd kept = MatrixXd::Zero(reduced_.a.rows(), ports);
  MatrixXd through = port_through_;
  MatrixXd forces = forces_by_port();
  MatrixXd driven = port_columns_(resting, Eigen::all);
  for (Index k = 0; k < ports; ++k) {
    const auto [axis, port] = ports_[static_cast<std::size_t>(k)];
    if (port == kFrictionPort) {
      through.col(k).setZero();
      forces.col(k).setZero();
      driven.col(k).setZero();
      for (const Index spring : springs) {
        if (reduced_.kept[static_cast<std::size_t>(spring)] == map_.bristle[static_cast<std::size_t>(axis)]) {
          kept(spring, k) = -1.0;
          driven.col(k) = -reduced_.a(resting, spring);
        }
      }
    }
  }
  const MatrixXd still = MatrixXd::Identity(count, count) - reduced_.a(resting, resting);
  const MatrixXd settled = still.partialPivLu().solve(driven);
  kept(resting, Eigen::all) = settled;
  const MatrixXd by_kept = reduced_.of_kept * kept;
  MatrixXd rows = motion(MatrixXd(by_kept + through), MatrixXd(force_by_state_ * by_kept + forces), 1.0);
  for (int axis = 0; axis < plant_.axes(); ++axis) {
    rows.row(Index{kMotionRows} * axis + kSlipRow).setZero();  // a law goes by the change of the slip
  }
  for (std::size_t k = 0; k < ports_.size(); ++k) {
    const auto [axis, port] = ports_[k];
    if (port == kSpringPort) {
      rows(Index{kMotionRows} * axis + kAttachRow, static_cast<Index>(k)) += 1.0;
    }
  }
  return rows;
}

}  // namespace hotfire::linear
