// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/statistics.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hotfire::explain {

namespace {

/// Sum of products of a series with itself `lag` later.
double lagged_product(std::span<const double> values, std::size_t lag) {
  const auto count = static_cast<Eigen::Index>(values.size() - lag);
  const Eigen::Map<const Eigen::VectorXd> series(values.data(), static_cast<Eigen::Index>(values.size()));
  return series.head(count).dot(series.tail(count));
}

/// 1 + 2 sum of a correlation over its lags, a pair of lags at a time until one is not positive, and at least 1. A sequence
/// that has not died out after a fifth of the record counts as one sample a fifth.
template <class CorrelationAt>
double initial_positive_sum(std::size_t rows, const CorrelationAt& correlation_at) {
  double g = 1.0;
  for (std::size_t lag = 1; lag + 1 < rows / 5; lag += 2) {
    const double pair = correlation_at(lag) + correlation_at(lag + 1);
    if (pair <= 0.0) {
      break;
    }
    g += 2.0 * pair;
  }
  return std::max(1.0, g);
}

}  // namespace

double root_mean_square(std::span<const double> values) {
  if (values.empty()) {
    return 0.0;
  }
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

namespace {

/// The mean square of third differences over short stretches, at a quantile of all stretches. Of fewer rows than a stretch,
/// over all of them.
double square_of_differences(std::span<const double> values, double quantile) {
  constexpr std::size_t kStretch = 64;
  std::vector<double> squares;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 3; i < values.size(); ++i) {
    const double third = values[i] - 3.0 * values[i - 1] + 3.0 * values[i - 2] - values[i - 3];
    sum += third * third;
    if (++count == kStretch) {
      squares.push_back(sum / static_cast<double>(count));
      sum = 0.0;
      count = 0;
    }
  }
  if (squares.empty()) {
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
  const auto at = squares.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(squares.size()));
  std::nth_element(squares.begin(), at, squares.end());
  return *at;
}

}  // namespace

double noise_from_differences(std::span<const double> values) {
  // The median of a chi-square mean over 64 correlated third differences lies 2 % below its mean (measured on white noise).
  constexpr double kMedianBias = 0.98;
  constexpr std::size_t kStretch = 64;
  const double bias = values.size() < kStretch + 3 ? 1.0 : kMedianBias;
  return std::sqrt(square_of_differences(values, 0.5) / bias / 20.0);
}

double quiet_noise(std::span<const double> values) { return std::sqrt(square_of_differences(values, 0.1) / 20.0); }

NoiseFloor noise_floor(std::span<const double> values) {
  constexpr double kComputed = 1e-7;
  constexpr double kAgreement = 1e-5;
  if (values.empty()) {
    return {};
  }
  const auto rows = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / rows;
  double square = 0.0;
  double size = 0.0;
  for (const double value : values) {
    square += (value - mean) * (value - mean);
    size = std::max(size, std::abs(value));
  }
  // Values that differ by less than this were printed or converted differently, not read differently.
  const double same = 1e-9 * size;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double apart = std::abs(values[i] - values[i - 1]);
    step = apart > same ? std::min(step, apart) : step;
  }
  const double rounding = std::isfinite(step) ? step / std::sqrt(12.0) : 0.0;
  const double motion = std::sqrt(square / rows);
  const double least = std::max(rounding, kComputed * motion);
  return {least, std::max(least, kAgreement * motion)};
}

std::vector<double> autocorrelation(std::span<const double> values, std::size_t last_lag) {
  std::vector<double> rho;
  const double energy = lagged_product(values, 0);
  for (std::size_t lag = 0; lag <= last_lag && lag < values.size(); ++lag) {
    rho.push_back(energy > 0.0 ? lagged_product(values, lag) / energy : 0.0);
  }
  return rho;
}

double statistical_inefficiency(std::span<const double> values) {
  const double energy = lagged_product(values, 0);
  if (!(energy > 0.0)) {
    return 1.0;
  }
  return initial_positive_sum(values.size(), [&](std::size_t lag) { return lagged_product(values, lag) / energy; });
}

double joint_inefficiency(std::span<const double> first, std::span<const double> second) {
  const double first_energy = lagged_product(first, 0);
  const double second_energy = lagged_product(second, 0);
  if (!(first_energy > 0.0) || !(second_energy > 0.0)) {
    return 1.0;
  }
  return initial_positive_sum(first.size(), [&](std::size_t lag) {
    return lagged_product(first, lag) / first_energy * (lagged_product(second, lag) / second_energy);
  });
}

}  // namespace hotfire::explain
