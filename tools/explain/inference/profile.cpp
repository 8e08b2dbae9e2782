// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/profile.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/inference/uncertainty.hpp"

namespace hotfire::explain {

namespace {

/// 95 % of chi-squared with one degree of freedom.
constexpr double kRise = 3.841459;
/// The error is taken for a parabola where it rises by this factor more or less.
constexpr double kLikeAParabola = 1.3;
/// An end is found where the error rises to within this of what it should; the interval is then known to 2 %.
constexpr double kFound = 0.15;
constexpr int kMostTrials = 8;
/// Steps in which the other parameters are fitted again, until one lowers the error by less than `kFitted`.
constexpr int kMostSteps = 5;
constexpr double kFitted = 0.03;

/// The error of a model about an optimum, with the derivatives taken there.
class Surroundings {
 public:
  Surroundings(const Evaluator& evaluator, const Fitted& optimum)
      : evaluator_(evaluator), optimum_(optimum), weight_(weights_of(evaluator, optimum.temper)) {}

  /// Takes the derivatives, and goes to where the error is least: a fit ends close to there, a part of a deviation away.
  /// False if the optimum can't be simulated with derivatives.
  bool differentiate(unsigned threads) {
    std::vector<std::size_t> all(optimum_.free.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (!evaluator_.differentiate(optimum_.base, optimum_.free, optimum_.u, all, threads, weighted_)) {
      return false;
    }
    weighted_ = weight_.asDiagonal() * weighted_;
    normal_ = weighted_.transpose() * weighted_;
    for (std::size_t k = 0; k < optimum_.free.size(); ++k) {
      normal_(index(k), index(k)) += optimum_.free[k].prior_curvature();
    }
    covariance_ = covariance_of(normal_);
    const auto least = least_of(optimum_.u, all);
    if (least) {
      at_ = least->u;
      cost_ = least->cost;
    }
    return least.has_value();
  }

  double value(std::size_t k, double deviations) const {
    return optimum_.free[k].value(within_range(k, at_[k] + deviations * deviation(k)));
  }

  double deviation(std::size_t k) const { return std::sqrt(covariance_(index(k), index(k))); }

  /// How far the error rises over the optimum's where parameter `k` is moved by so many deviations and the others go with it
  /// as the curvature says.
  std::optional<double> rise_on_ridge(std::size_t k, double deviations) const {
    const std::vector<double> u = ridge(k, deviations);
    const auto residual = weighted_residual(u);
    return residual ? std::optional(cost_of(*residual, u) - cost_) : std::nullopt;
  }

  /// The same with the others fitted again.
  std::optional<double> rise(std::size_t k, double deviations) const {
    std::vector<std::size_t> others(optimum_.free.size());
    std::iota(others.begin(), others.end(), std::size_t{0});
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto least = least_of(ridge(k, deviations), others);
    return least ? std::optional(least->cost - cost_) : std::nullopt;
  }

  /// Deviations beyond which parameter `k` would leave its range.
  double most_deviations(std::size_t k, double side) const {
    const auto [low, high] = optimum_.free[k].range();
    return (side < 0.0 ? at_[k] - low : high - at_[k]) / deviation(k);
  }

 private:
  static Eigen::Index index(std::size_t k) { return static_cast<Eigen::Index>(k); }

  double within_range(std::size_t k, double u) const {
    const auto [low, high] = optimum_.free[k].range();
    return std::clamp(u, low, high);
  }

  std::vector<double> ridge(std::size_t k, double deviations) const {
    std::vector<double> u = at_;
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = within_range(i, u[i] + deviations * covariance_(index(i), index(k)) / deviation(k));
    }
    return u;
  }

  std::optional<Eigen::VectorXd> weighted_residual(const std::vector<double>& u) const {
    Prediction prediction;
    if (!evaluator_.predict(optimum_.base, optimum_.free, u, 1, prediction)) {
      return std::nullopt;
    }
    return evaluator_.residuals(prediction).cwiseProduct(weight_);
  }

  double cost_of(const Eigen::VectorXd& weighted_residual, const std::vector<double>& u) const {
    return weighted_residual.squaredNorm() + prior_cost(optimum_.free, u);
  }

  Eigen::VectorXd gradient(const Eigen::VectorXd& weighted_residual, const std::vector<double>& u) const {
    Eigen::VectorXd gradient = weighted_.transpose() * weighted_residual;
    for (std::size_t k = 0; k < u.size(); ++k) {
      gradient(index(k)) += optimum_.free[k].prior_slope(u[k]);
    }
    return gradient;
  }

  struct Least {
    std::vector<double> u;
    double cost = 0.0;
  };

  /// Where the error is least over the parameters `moved`, in steps along the derivatives at the optimum.
  std::optional<Least> least_of(std::vector<double> u, const std::vector<std::size_t>& moved) const {
    auto residual = weighted_residual(u);
    if (!residual) {
      return std::nullopt;
    }
    Least least{u, cost_of(*residual, u)};
    const Eigen::LLT<Eigen::MatrixXd> solver(Eigen::MatrixXd(normal_(moved, moved)));
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::VectorXd move = -solver.solve(Eigen::VectorXd(gradient(*residual, u)(moved)));
      for (std::size_t i = 0; i < moved.size(); ++i) {
        u[moved[i]] = within_range(moved[i], u[moved[i]] + move(index(i)));
      }
      residual = weighted_residual(u);
      const double drop = residual ? least.cost - cost_of(*residual, u) : 0.0;
      if (drop > 0.0) {
        least = {u, least.cost - drop};
      }
      if (drop < kFitted) {
        break;
      }
    }
    return least;
  }

  const Evaluator& evaluator_;
  const Fitted& optimum_;
  Eigen::VectorXd weight_;
  Eigen::MatrixXd weighted_;  ///< derivatives of the weighted residuals
  Eigen::MatrixXd normal_;
  Eigen::MatrixXd covariance_;
  std::vector<double> at_;  ///< where the error is least
  double cost_ = 0.0;       ///< the error there
};

bool is_like_a_parabola(const std::optional<double>& rise) {
  return rise && *rise > kRise / kLikeAParabola && *rise < kRise * kLikeAParabola;
}

/// How many deviations to a side the interval of parameter `k` ends; none if its range ends before, or no end is found.
std::optional<double> end_of(const Surroundings& surroundings, std::size_t k, double side) {
  const double most = surroundings.most_deviations(k, side);
  double inside = 0.0;
  double outside = most;
  double tried = std::min(kTwoSided95, most);
  for (int trial = 0; trial < kMostTrials && outside - inside > 1e-3 * outside; ++trial) {
    const std::optional<double> rise = surroundings.rise(k, side * tried);
    if (!rise) {
      return std::nullopt;
    }
    if (std::abs(*rise - kRise) < kFound) {
      return tried;
    }
    (*rise < kRise ? inside : outside) = tried;
    // As if it were a parabola from the optimum on; halfway between the ends where that leads out of them.
    const double next = tried * std::clamp(std::sqrt(kRise / std::max(1e-3, *rise)), 0.3, 3.0);
    tried = next > inside && next < outside ? next : 0.5 * (inside + outside);
  }
  return std::nullopt;
}

}  // namespace

Intervals profile_intervals(const Evaluator& evaluator, const Fitted& fitted, unsigned threads) {
  std::vector<std::size_t> wanted;
  const std::vector<Estimate> estimated = estimates(fitted.free, fitted.u, fitted.normal);
  for (std::size_t k = 0; k < fitted.free.size(); ++k) {
    const FreeParameter& parameter = fitted.free[k];
    if (parameter.address.is_of_effect() && !parameter.is_ordinate() && estimated[k].interval) {
      wanted.push_back(k);
    }
  }
  Surroundings surroundings(evaluator, fitted);
  if (fitted.chaotic || wanted.empty() || !surroundings.differentiate(threads)) {
    return {};
  }
  constexpr std::array kSides{-1.0, 1.0};
  std::vector<std::array<std::optional<double>, 2>> rises(wanted.size());
  parallel_for(2 * wanted.size(), threads, [&](std::size_t i) {
    rises[i / 2][i % 2] = surroundings.rise_on_ridge(wanted[i / 2], kSides[i % 2] * kTwoSided95);
  });
  std::vector<std::array<std::optional<double>, 2>> ends(wanted.size());
  parallel_for(2 * wanted.size(), threads, [&](std::size_t i) {
    if (!is_like_a_parabola(rises[i / 2][0]) || !is_like_a_parabola(rises[i / 2][1])) {
      ends[i / 2][i % 2] = end_of(surroundings, wanted[i / 2], kSides[i % 2]);
    }
  });
  Intervals intervals;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::size_t k = wanted[i];
    if (ends[i][0] && ends[i][1]) {
      intervals[fitted.free[k].address] =
          std::minmax({surroundings.value(k, -*ends[i][0]), surroundings.value(k, *ends[i][1])});
    }
  }
  return intervals;
}

}  // namespace hotfire::explain
