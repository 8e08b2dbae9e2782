// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "tools/explain/data/statistics.hpp"

namespace hotfire::explain {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A fit that has converged is tried again under new derivatives if it took off more than this many times its tolerance.
constexpr double kWayOn = 10.0;

/// A least-squares problem of n values with the same cost, gradient and J^T J as one of any number of rows: n + 1 residuals
/// whatever the length of the records, so that the solver's own work does not grow with them.
struct Compressed {
  Eigen::MatrixXd jacobian;  ///< (n + 1) x n
  Eigen::VectorXd residual;  ///< n + 1
};

/// Share of the largest eigenvalue (at most n) below which a direction carries no information: the square of what the
/// derivatives are off by.
constexpr double kNoInformation = 1e-10;

Compressed compress(const Eigen::MatrixXd& normal, const Eigen::VectorXd& gradient, double cost) {
  const Eigen::Index n = normal.rows();
  Eigen::VectorXd scale = normal.diagonal().cwiseMax(0.0).cwiseSqrt();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Compressed compressed{Eigen::MatrixXd::Zero(n + 1, n), Eigen::VectorXd::Zero(n + 1)};
  const Eigen::VectorXd rotated = eigen.eigenvectors().transpose() * gradient.cwiseQuotient(scale);
  double explained = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double value = eigen.eigenvalues()(i);
    if (value > kNoInformation * static_cast<double>(n)) {
      const double root = std::sqrt(value);
      compressed.jacobian.row(i) = root * (eigen.eigenvectors().col(i).cwiseProduct(scale)).transpose();
      compressed.residual(i) = rotated(i) / root;
      explained += compressed.residual(i) * compressed.residual(i);
    }
  }
  compressed.residual(n) = std::sqrt(std::max(0.0, cost - explained));
  return compressed;
}

/// Simulation error of all experiments and the priors, as one block of Ceres.
class SimulationError : public ceres::CostFunction {
 public:
  SimulationError(const Evaluator& evaluator, Fitted& fitted, const FitOptions& options, Tangent& tangent)
      : fitted_(fitted), options_(options), tangent_(tangent), weight_(weights_of(evaluator, fitted.temper)) {
    set_num_residuals(static_cast<int>(fitted.free.size()) + 1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(fitted.free.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto count = static_cast<Eigen::Index>(fitted_.free.size());
    const std::span<const double> u(parameters[0], fitted_.free.size());
    const bool want_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::VectorXd residual;
    if (!simulate(u, want_jacobian, residual)) {
      return false;
    }
    residual = residual.cwiseProduct(weight_);
    const double cost = residual.squaredNorm() + prior_cost(fitted_.free, u);
    Eigen::Map<Eigen::VectorXd> out(residuals, count + 1);
    if (!want_jacobian) {
      out.setZero();
      out(count) = std::sqrt(cost);
      return true;
    }
    if (tangent_.revision() != weighted_revision_) {
      weigh();
    }
    Eigen::VectorXd gradient = weighted_.transpose() * residual;
    for (std::size_t k = 0; k < fitted_.free.size(); ++k) {
      gradient(static_cast<Eigen::Index>(k)) += fitted_.free[k].prior_slope(u[k]);
    }
    const Compressed compressed = compress(fitted_.normal, gradient, cost);
    out = compressed.residual;
    Eigen::Map<RowMajor>(jacobians[0], count + 1, count) = compressed.jacobian;
    return true;
  }

  /// Drops derivatives that were not taken at the fit's current point. False if they were.
  bool renew() const {
    if (!tangent_.is_borrowed_at(simulated_at(fitted_.u))) {
      return false;
    }
    tangent_.forget();
    return true;
  }

 private:
  /// Brings what depends on the derivatives alone up to them: the weighted Jacobian of all parameters, and J^T J with the
  /// priors.
  void weigh() const {
    const auto count = static_cast<Eigen::Index>(fitted_.free.size());
    const Eigen::MatrixXd& own = tangent_.jacobian();
    weighted_.resize(weight_.size(), count);
    if (count > own.cols()) {
      weighted_.leftCols(count - own.cols()) = weight_.asDiagonal() * options_.frozen->jacobian;
    }
    weighted_.rightCols(own.cols()) = weight_.asDiagonal() * own;
    fitted_.normal = weighted_.transpose() * weighted_;
    for (Eigen::Index k = 0; k < count; ++k) {
      fitted_.normal(k, k) += fitted_.free[static_cast<std::size_t>(k)].prior_curvature();
    }
    weighted_revision_ = tangent_.revision();
  }

  /// `u` with the frozen parameters where they are frozen.
  std::vector<double> simulated_at(std::span<const double> u) const {
    std::vector<double> at(u.begin(), u.end());
    if (options_.frozen != nullptr) {
      std::copy(options_.frozen->u.begin(), options_.frozen->u.end(), at.begin());
    }
    return at;
  }

  /// Residuals over noise, with the frozen parameters moved linearly; leaves the derivatives of the others in the tangent.
  bool simulate(std::span<const double> u, bool want_jacobian, Eigen::VectorXd& residual) const {
    const std::vector<double> at = simulated_at(u);
    if (!(want_jacobian ? tangent_.differentiate_at(at) : tangent_.move_to(at))) {
      return false;
    }
    if (want_jacobian) {
      fitted_.chaotic = options_.slopes == Slopes::narrow && tangent_.slopes() == Slopes::wide;
    }
    residual = tangent_.residual();
    if (options_.frozen != nullptr && !options_.frozen->u.empty()) {
      const auto frozen = static_cast<Eigen::Index>(options_.frozen->u.size());
      residual += options_.frozen->jacobian * (Eigen::Map<const Eigen::VectorXd>(u.data(), frozen) -
                                               Eigen::Map<const Eigen::VectorXd>(options_.frozen->u.data(), frozen));
    }
    return true;
  }

  Fitted& fitted_;
  FitOptions options_;
  Tangent& tangent_;
  Eigen::VectorXd weight_;
  mutable Eigen::MatrixXd weighted_;
  mutable int weighted_revision_ = 0;  ///< the derivatives that `weighted_` is of
};

/// Variance of the noise of a stretch over that of its channel in all records.
double relative_variance(const Dataset& data, const Stretch& stretch) {
  const double ratio = data.experiments[stretch.experiment].noise[stretch.channel] / data.noise[stretch.channel];
  return ratio * ratio;
}

}  // namespace

Tangent tangent_of(const Evaluator& evaluator, const Fitted& fitted, const FitOptions& options) {
  const std::size_t frozen = options.frozen != nullptr ? options.frozen->u.size() : 0;
  std::vector<std::size_t> simulated(fitted.free.size() - frozen);
  std::iota(simulated.begin(), simulated.end(), frozen);
  return {evaluator, fitted.base, fitted.free, std::move(simulated), options.slopes, options.threads};
}

bool fit(const Evaluator& evaluator, Fitted& fitted, const FitOptions& options) {
  Tangent tangent = tangent_of(evaluator, fitted, options);
  return fit(evaluator, fitted, options, tangent);
}

bool fit(const Evaluator& evaluator, Fitted& fitted, const FitOptions& options, Tangent& tangent) {
  if (fitted.free.empty()) {
    fitted.converged = true;
    return true;
  }
  auto* error = new SimulationError(evaluator, fitted, options, tangent);  // the problem owns it
  ceres::Problem problem;
  problem.AddResidualBlock(error, nullptr, fitted.u.data());
  for (std::size_t k = 0; k < fitted.free.size(); ++k) {
    const FreeParameter& parameter = fitted.free[k];
    const auto [low, high] = parameter.range();
    const int position = static_cast<int>(k);
    problem.SetParameterLowerBound(fitted.u.data(), position, low);
    problem.SetParameterUpperBound(fitted.u.data(), position, high);
    fitted.u[k] = std::clamp(fitted.u[k], low, high);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-7;
  solver.gradient_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  // With bounds Ceres would search along every step, which takes derivatives wherever it looks and, where the error has
  // ripples, settles for a move too small to count. A rejected step costs one simulation and turns the next one.
  solver.max_num_line_search_step_size_iterations = 0;
  // A fit ends where derivatives taken there find no way on: borrowed ones may see none where there is one.
  ceres::Solver::Summary summary;
  for (int left = options.iterations; left > 0; left -= summary.num_successful_steps + summary.num_unsuccessful_steps) {
    solver.max_num_iterations = left;
    ceres::Solve(solver, &problem, &summary);
    fitted.converged = summary.termination_type == ceres::CONVERGENCE;
    const double drop = summary.initial_cost - summary.final_cost;
    if (!fitted.converged || !error->renew() || drop < kWayOn * options.tolerance * summary.initial_cost) {
      break;
    }
  }
  return summary.IsSolutionUsable();
}

Temper temper_of(const Evaluator& evaluator, const Eigen::VectorXd& residual) {
  const std::size_t channels = evaluator.data().channels.size();
  std::vector<double> inflated(channels, 0.0);
  std::vector<double> count(channels, 0.0);
  for (const Stretch& s : evaluator.stretches()) {
    const std::span<const double> part(residual.data() + s.offset, s.last - s.first);
    const double sum = std::inner_product(part.begin(), part.end(), part.begin(), 0.0);
    inflated[s.channel] += sum * statistical_inefficiency(part) * relative_variance(evaluator.data(), s);
    count[s.channel] += static_cast<double>(part.size());
  }
  Temper temper(channels, 1.0);
  for (std::size_t c = 0; c < channels; ++c) {
    if (count[c] > 0.0) {
      temper[c] = std::max(1.0, inflated[c] / count[c]);
    }
  }
  return temper;
}

Eigen::VectorXd weights_of(const Evaluator& evaluator, const Temper& temper) {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(evaluator.fit_rows()));
  for (const Stretch& s : evaluator.stretches()) {
    const double variance = relative_variance(evaluator.data(), s);
    weights.segment(static_cast<Eigen::Index>(s.offset), static_cast<Eigen::Index>(s.last - s.first))
        .setConstant(std::sqrt(variance / (variance + temper[s.channel] - 1.0)));
  }
  return weights;
}

}  // namespace hotfire::explain
