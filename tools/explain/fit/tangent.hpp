// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "tools/explain/fit/slopes.hpp"

namespace hotfire::explain {

/// Residuals along the way of a fit, with derivatives that are taken again only where they no longer hold: a simulation with
/// derivatives costs as much as several without. Narrow ones hold as long as the residuals have moved as they said; wide
/// ones over the width of their differences, within which they resolve nothing finer.
class Tangent {
 public:
  /// Of `evaluator` under `base` with the coordinates of `free`, with derivatives for the parameters `wanted`, taken as
  /// `asked`.
  Tangent(const Evaluator& evaluator, const ModelParameters& base, std::span<const FreeParameter> free,
          std::vector<std::size_t> wanted, Slopes asked, unsigned threads)
      : evaluator_(evaluator), base_(base), free_(free), wanted_(std::move(wanted)), asked_(asked), threads_(threads) {}

  /// Starts with a known residual at `u`, which is then not simulated again.
  void begin_at(std::vector<double> u, Eigen::VectorXd residual) {
    at_ = std::move(u);
    residual_ = std::move(residual);
  }
  /// Simulates at `u`. False if a state did not stay finite.
  bool move_to(std::span<const double> u);
  /// As `move_to`, with derivatives.
  bool differentiate_at(std::span<const double> u);

  /// The derivatives were taken elsewhere than at `u`.
  bool is_borrowed_at(std::span<const double> u) const {
    return !std::equal(u.begin(), u.end(), taken_at_.begin(), taken_at_.end());
  }
  /// Takes them again at the next call.
  void forget() { taken_at_.clear(); }

  /// What the last call found: over noise, on the rows a fit sees.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// A column for each of `wanted`.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  Slopes slopes() const { return slopes_; }
  /// How often they were taken.
  int revision() const { return revision_; }

 private:
  bool holds_at(std::span<const double> u) const;

  const Evaluator& evaluator_;
  const ModelParameters& base_;
  std::span<const FreeParameter> free_;
  std::vector<std::size_t> wanted_;
  Slopes asked_;
  unsigned threads_;
  std::vector<double> at_;  ///< where `residual_` holds
  Eigen::VectorXd residual_;
  std::vector<double> taken_at_;  ///< where the derivatives were taken, with `taken_residual_`
  Eigen::VectorXd taken_residual_;
  Eigen::MatrixXd jacobian_;
  Slopes slopes_ = Slopes::narrow;
  int revision_ = 0;
};

}  // namespace hotfire::explain
