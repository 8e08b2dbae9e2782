// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "tools/explain/fit/parameter_space.hpp"

namespace hotfire::explain {

/// Standard deviations to either side that hold 95 % of a normal distribution.
inline constexpr double kTwoSided95 = 1.959964;

/// A fitted value with its 95 % interval.
struct Estimate {
  double value = 0.0;
  std::optional<std::pair<double, double>> interval;  ///< none where the data do not determine the parameter
  bool from_profile = false;                          ///< the interval is of the profile likelihood
  bool pressed = false;                               ///< ended at a bound, or beyond 2.5 of its declared tolerances
};

/// Covariance of the coordinates from J^T J at an optimum, priors included: directions that the data leave open are given a
/// variance that no interval survives.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& normal);

/// Estimates of all free parameters from J^T J at the optimum. The residuals were tempered by their effective sample size,
/// so its inverse is the covariance. A parameter is determined if its half interval is under a factor of three (searched in
/// logarithms), under its own size (linear), or under 0.9 of its tolerance's.
std::vector<Estimate> estimates(const std::vector<FreeParameter>& free, const std::vector<double>& u,
                                const Eigen::MatrixXd& normal);

}  // namespace hotfire::explain
