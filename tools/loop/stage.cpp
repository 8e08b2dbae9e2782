// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/stage.hpp"

#include <vector>

#include "model/structure/mode.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::loop {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

std::string axis_name(int i) { return (i % 2 == 0 ? "pitch" : "yaw") + std::to_string(i / 2 + 1); }

Stage::Stage(const MasvParameters& vehicle, const FlightModes& modes, const std::string& channel)
    : frequency_(modes.frequency), damping_ratio_(modes.damping_ratio), force_(modes.side) {
  if (modes.side.size() == 0) {
    throw UsageError(
        "the mode table has no shapes of the side force and of the sensor; remedy: give it the columns side.pitch1 ... "
        "side.yaw4, sensor.pitch and sensor.yaw");
  }
  if (frequency_.minCoeff() > 0.0) {
    throw UsageError("the mode table has no rigid-body mode; remedy: rows with the frequency 0");
  }
  for (Index i = 0; i < force_.rows(); ++i) {
    force_.row(i) *= vehicle.gimbals[static_cast<std::size_t>(i / 2)].bearing.thrust;
  }
  if (force_.cwiseAbs().maxCoeff() == 0.0) {
    throw UsageError("the engines have no thrust that could turn the stage; remedy: --thrust, or gimbal.thrust above 0");
  }
  sensor_ = modes.sensor.row(channel == "pitch" ? 0 : 1).transpose();
  if (sensor_.cwiseAbs().maxCoeff() == 0.0) {
    throw UsageError("no mode turns the sensor about " + channel + "; remedy: a sensor." + channel + " that is not 0");
  }
  // What the sensor does not see is no part of the loop.
  std::vector<Index> seen;
  for (Index k = 0; k < sensor_.size(); ++k) {
    if (sensor_(k) != 0.0) {
      seen.push_back(k);
    }
  }
  frequency_ = frequency_(seen).eval();
  damping_ratio_ = damping_ratio_(seen).eval();
  force_ = force_(Eigen::all, seen).eval();
  sensor_ = sensor_(seen).eval();
}

MatrixXcd Stage::response(double frequency) const {
  const double angle = kTurn * frequency;
  MatrixXcd gains = MatrixXcd::Zero(2, axes());
  for (Index k = 0; k < modes(); ++k) {
    const double w = kTurn * frequency_(k);
    const Complex mode = 1.0 / Complex(w * w - angle * angle, 2.0 * damping_ratio_(k) * w * angle);
    const Eigen::RowVectorXcd moved = (sensor_(k) * mode) * force_.col(k).transpose().cast<Complex>();
    gains.row(0) += moved;
    gains.row(1) += Complex(0.0, angle) * moved;
  }
  return gains;
}

Stage::Step Stage::step(double h) const {
  const Index states = 2 * Index{modes()};
  Step step{MatrixXd::Zero(states, states), MatrixXd::Zero(states, axes()), MatrixXd::Zero(2, states)};
  for (Index k = 0; k < modes(); ++k) {
    const double w = kTurn * frequency_(k);
    Eigen::Matrix2d own;
    Eigen::Vector2d forced;
    if (w > 0.0) {
      const auto position = model::advance_mode<double>({1.0, 0.0}, w, damping_ratio_(k), h);
      const auto rate = model::advance_mode<double>({0.0, 1.0}, w, damping_ratio_(k), h);
      own << position.displacement, rate.displacement, position.velocity, rate.velocity;
      forced << (1.0 - position.displacement) / (w * w), -position.velocity / (w * w);
    } else {
      own << 1.0, h, 0.0, 1.0;
      forced << 0.5 * h * h, h;
    }
    step.by_state.block<2, 2>(2 * k, 2 * k) = own;
    step.by_angle.middleRows<2>(2 * k) = forced * force_.col(k).transpose();
    step.read(0, 2 * k) = sensor_(k);
    step.read(1, 2 * k + 1) = sensor_(k);
  }
  return step;
}

VectorXd Stage::turned(double attitude) const {
  double size = 0.0;
  for (Index k = 0; k < modes(); ++k) {
    size += frequency_(k) == 0.0 ? sensor_(k) * sensor_(k) : 0.0;
  }
  VectorXd state = VectorXd::Zero(2 * Index{modes()});
  for (Index k = 0; k < modes(); ++k) {
    state(2 * k) = frequency_(k) == 0.0 && size > 0.0 ? attitude * sensor_(k) / size : 0.0;
  }
  return state;
}

}  // namespace hotfire::loop
