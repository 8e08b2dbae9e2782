// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/vehicle_loop.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/files/text/error.hpp"
#include "tools/linear/linear_model.hpp"
#include "tools/linear/reduction.hpp"

namespace hotfire::loop {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// How far apart two points of a loop are, for the choice of a start.
double distance(double frequency, double amplitude, double other_frequency, double other_amplitude) {
  return std::abs(std::log(frequency / other_frequency)) + std::abs(std::log(amplitude / other_amplitude));
}

}  // namespace

VehicleLoop::VehicleLoop(const linear::Plant& plant, const Stage& stage, const Controller& controller)
    : plant_(plant), stage_(stage), controller_(controller), step_(plant.step()) {
  const auto period_steps = static_cast<int>(std::lround(controller.period / step_));
  const auto delay_steps = static_cast<int>(std::lround(controller.delay / step_));
  constexpr double kSame = 1e-9;  // s
  if (std::abs(delay_steps * step_ - controller.delay) > kSame) {
    throw FileError(fmt::format("{}delay = {:g} s: not a whole number of the model's steps of {:g} s; nearest: {:g} s",
                                controller.delay_at, controller.delay, step_, delay_steps * step_));
  }
  for (int i = 0; i < plant.axes(); ++i) {
    commanded_.push_back(axis_name(i).starts_with(controller.axis) ? 1.0 : 0.0);
  }
  const linear::LinearModel model = linear::small_signal_model(plant, step_);
  std::vector<Index> rows;
  for (int i = 0; i < plant.axes(); ++i) {
    const int place = linear::place_of(model.outputs, "engine." + axis_name(i), "output");
    rows.push_back(place);
    engines_.push_back(static_cast<std::size_t>(place));
  }
  // The plant's states, then the stage's, over a step: the stage is moved by the mean of the angles at both ends.
  const Stage::Step own = stage.step(step_);
  const VectorXd commanded = Eigen::Map<const VectorXd>(commanded_.data(), plant.axes());
  const VectorXd into = model.step_b.leftCols(plant.axes()) * commanded;
  const MatrixXd read = model.c(rows, Eigen::all);
  const MatrixXd all_through = model.d(rows, Eigen::all);
  const VectorXd through = all_through.leftCols(plant.axes()) * commanded;
  const Index first = model.step_a.rows();
  const Index states = first + own.by_state.rows();
  MatrixXd step_a = MatrixXd::Zero(states, states);
  step_a.topLeftCorner(first, first) = model.step_a;
  step_a.bottomLeftCorner(states - first, first) = 0.5 * own.by_angle * (read + read * model.step_a);
  step_a.bottomRightCorner(states - first, states - first) = own.by_state;
  VectorXd step_b(states);
  step_b << into, own.by_angle * (0.5 * (read * into) + through);
  c_ = MatrixXd::Zero(2, states);
  c_.rightCols(states - first) = own.read;

  a_ = MatrixXd::Identity(states, states);
  late_ = VectorXd::Zero(states);
  own_ = VectorXd::Zero(states);
  whole_periods_ = delay_steps / period_steps;
  const int rest = delay_steps % period_steps;
  for (int k = 0; k < period_steps; ++k) {
    // Powers from the end of the period backwards: the last steps are under the sample's own command.
    (k < period_steps - rest ? own_ : late_) += a_ * step_b;
    a_ = (step_a * a_).eval();
  }
}

std::optional<bool> VehicleLoop::is_stable() const {
  if (controller_.is_measured()) {
    return {};
  }
  // States: the vehicle's, the law's, and the commands of the samples before, the latest first.
  const Controller::Law law = controller_.law();
  const Index vehicle = a_.rows();
  const Index memory = law.a.rows();
  const Index first = vehicle + memory;
  const Index all = first + whole_periods_ + 1;
  Eigen::RowVectorXd command = Eigen::RowVectorXd::Zero(all);
  command.head(vehicle) = -(law.d * c_);
  command.segment(vehicle, memory) = -law.c;
  const auto command_of = [&](Index ago) {
    return ago == 0 ? command : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(all, first + ago - 1));
  };
  MatrixXd closed = MatrixXd::Zero(all, all);
  closed.topLeftCorner(vehicle, vehicle) = a_;
  closed.topRows(vehicle) += own_ * command_of(whole_periods_) + late_ * command_of(whole_periods_ + 1);
  closed.block(vehicle, 0, memory, vehicle) = law.b * c_;
  closed.block(vehicle, vehicle, memory, memory) = law.a;
  for (Index ago = 0; ago <= whole_periods_; ++ago) {
    closed.row(first + ago) = command_of(ago);
  }
  const VectorXd scale = linear::balancing(closed);
  const MatrixXd balanced = scale.asDiagonal().inverse() * closed * scale.asDiagonal();
  // Motions that nobody commands, as the yaw of a pitch loop, stay as they are: a double eigenvalue of 1, known to the root
  // of the rounding.
  constexpr double kRounding = 1e-6;
  return Eigen::EigenSolver<MatrixXd>(balanced, false).eigenvalues().cwiseAbs().maxCoeff() <= 1.0 + kRounding;
}

Complex VehicleLoop::small_signal(double frequency) const {
  const Complex turn = std::polar(1.0, kTurn * frequency * controller_.period);
  const auto states = a_.rows();
  const VectorXcd driven = (own_.cast<Complex>() + late_.cast<Complex>() / turn) * std::pow(turn, -whole_periods_);
  const MatrixXcd dynamics = turn * MatrixXcd::Identity(states, states) - a_.cast<Complex>();
  const VectorXcd read = c_ * dynamics.partialPivLu().solve(driven);
  return controller_.response(frequency, read(0), read(1));
}

std::optional<Complex> VehicleLoop::described(double frequency, double amplitude) {
  const Known* nearest = nullptr;
  double least = 1.0;  // further away a start is none
  for (const Known& own : known_) {
    const double far = distance(frequency, amplitude, own.frequency, own.amplitude);
    if (far == 0.0) {
      return own.loop;
    }
    if (far < least) {
      least = far;
      nearest = &own;
    }
  }
  if (!balance_) {
    balance_ = std::make_unique<linear::HarmonicBalance>(plant_);
  }
  const Complex acting = amplitude * linear::hold_factor(frequency, controller_.period, step_) *
                         linear::delay_factor(frequency, controller_.delay);
  std::vector<Complex> commands;
  std::transform(commanded_.begin(), commanded_.end(), std::back_inserter(commands),
                 [&](double own) { return own * acting; });
  std::optional<linear::Balance> found =
      balance_->solve(frequency, commands, nearest == nullptr ? nullptr : &nearest->balance);
  if (!found && nearest != nullptr) {
    found = balance_->solve(frequency, commands);
  }
  if (!found) {
    return {};
  }
  VectorXcd angles(plant_.axes());
  for (std::size_t i = 0; i < engines_.size(); ++i) {
    angles(static_cast<Index>(i)) = found->outputs[engines_[i]] / amplitude;
  }
  const VectorXcd read = stage_.response(frequency) * angles;
  const Complex loop = controller_.response(frequency, read(0), read(1));
  known_.push_back({frequency, amplitude, loop, std::move(*found)});
  constexpr std::size_t kWithSlopes = 12;  // 12 MB each for eight axes, four times as much where a motion is not symmetric
  if (known_.size() > kWithSlopes) {
    known_[known_.size() - 1 - kWithSlopes].balance.slopes.reset();
  }
  return loop;
}

}  // namespace hotfire::loop
