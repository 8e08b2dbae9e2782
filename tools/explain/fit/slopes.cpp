// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/slopes.hpp"

#include <algorithm>
#include <vector>

#include "tools/explain/fit/parallel.hpp"

namespace hotfire::explain {

namespace {

/// The whole range of a sensor is thousands of times its noise: a reading that moves by more than a million for one unit of
/// a parameter (one tolerance, a factor e) is a derivative that ran away.
constexpr double kRunawaySlope = 1e6;

bool differences(const Evaluator& evaluator, const ModelParameters& base, std::span<const FreeParameter> free,
                 std::span<const double> u, std::span<const std::size_t> wanted, unsigned threads,
                 Eigen::MatrixXd& jacobian) {
  const std::size_t count = wanted.size();
  std::vector<Eigen::VectorXd> sides(2 * count);
  std::vector<double> reached(2 * count, 0.0);
  parallel_for(sides.size(), threads, [&](std::size_t i) {
    std::vector<double> at(u.begin(), u.end());
    const FreeParameter& parameter = free[wanted[i / 2]];
    const double step = wide_step(parameter);
    const auto [low, high] = parameter.range();
    double& moved = at[wanted[i / 2]];
    moved = std::clamp(moved + (i % 2 == 0 ? -step : step), low, high);
    reached[i] = moved;
    Prediction prediction;
    if (evaluator.predict(base, free, at, 1, prediction)) {
      sides[i] = evaluator.residuals(prediction);
    }
  });
  if (std::any_of(sides.begin(), sides.end(), [](const Eigen::VectorXd& side) { return side.size() == 0; })) {
    return false;
  }
  jacobian.resize(static_cast<Eigen::Index>(evaluator.fit_rows()), static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    jacobian.col(static_cast<Eigen::Index>(k)) = (sides[2 * k + 1] - sides[2 * k]) / (reached[2 * k + 1] - reached[2 * k]);
  }
  return true;
}

}  // namespace

double wide_step(const FreeParameter& parameter) { return parameter.is_declared() ? 0.3 : 0.1; }

std::optional<Slopes> differentiate(const Evaluator& evaluator, const ModelParameters& base,
                                    std::span<const FreeParameter> free, std::span<const double> u,
                                    std::span<const std::size_t> wanted, Slopes asked, unsigned threads,
                                    Eigen::MatrixXd& jacobian) {
  if (asked == Slopes::narrow && evaluator.differentiate(base, free, u, wanted, threads, jacobian) &&
      (jacobian.size() == 0 || jacobian.cwiseAbs().maxCoeff() < kRunawaySlope)) {
    return Slopes::narrow;
  }
  return differences(evaluator, base, free, u, wanted, threads, jacobian) ? std::optional(Slopes::wide) : std::nullopt;
}

}  // namespace hotfire::explain
