// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/tangent.hpp"

#include <algorithm>
#include <cmath>

namespace hotfire::explain {

namespace {

/// Share of a move that the derivatives may have missed. They are then off by twice as much, and a fit still closes in by a
/// factor of five an iteration.
constexpr double kMissed = 0.1;

}  // namespace

bool Tangent::move_to(std::span<const double> u) {
  if (std::equal(u.begin(), u.end(), at_.begin(), at_.end())) {
    return true;
  }
  Prediction prediction;
  if (!evaluator_.predict(base_, free_, u, threads_, prediction)) {
    return false;
  }
  residual_ = evaluator_.residuals(prediction);
  at_.assign(u.begin(), u.end());
  return true;
}

bool Tangent::differentiate_at(std::span<const double> u) {
  if (!move_to(u)) {
    return false;
  }
  if (!taken_at_.empty() && holds_at(u)) {
    return true;
  }
  const auto taken = differentiate(evaluator_, base_, free_, u, wanted_, asked_, threads_, jacobian_);
  if (!taken) {
    taken_at_.clear();
    return false;
  }
  slopes_ = *taken;
  ++revision_;
  taken_at_ = at_;
  taken_residual_ = residual_;
  return true;
}

bool Tangent::holds_at(std::span<const double> u) const {
  Eigen::VectorXd move(static_cast<Eigen::Index>(wanted_.size()));
  bool within_width = true;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const std::size_t k = wanted_[i];
    const double moved = u[k] - taken_at_[k];
    move(static_cast<Eigen::Index>(i)) = moved;
    within_width = within_width && std::abs(moved) <= wide_step(free_[k]);
  }
  if (slopes_ == Slopes::wide) {
    return within_width;
  }
  const Eigen::VectorXd said = jacobian_ * move;
  return (residual_ - taken_residual_ - said).squaredNorm() <= kMissed * kMissed * said.squaredNorm();
}

}  // namespace hotfire::explain
