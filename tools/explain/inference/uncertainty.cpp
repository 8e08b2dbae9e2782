// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hotfire::explain {

namespace {

/// A declared value further than this many tolerances from where it was declared is reported.
constexpr double kFarFromDeclared = 2.5;

/// True if a fit that is stopped by a bound would end here.
bool meets(double value, double bound) { return std::abs(value - bound) <= 1e-4 * std::abs(bound); }

/// The size against which a parameter that may be zero is determined: of a curve's ordinate that of the whole curve.
double size_of(const std::vector<FreeParameter>& free, const std::vector<double>& u, std::size_t k) {
  double size = std::abs(free[k].value(u[k]));
  for (std::size_t other = 0; free[k].is_ordinate() && other < free.size(); ++other) {
    if (free[other].is_ordinate() && free[other].address.owner == free[k].address.owner) {
      size = std::max(size, std::abs(free[other].value(u[other])));
    }
  }
  return size;
}

}  // namespace

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd scale = (normal.diagonal().array() > 0.0).select(normal.diagonal().cwiseMax(0.0).cwiseSqrt(), 1.0);
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(1e-14).cwiseInverse();
  const Eigen::MatrixXd covariance = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  return scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
}

std::vector<Estimate> estimates(const std::vector<FreeParameter>& free, const std::vector<double>& u,
                                const Eigen::MatrixXd& normal) {
  std::vector<Estimate> result;
  Eigen::VectorXd deviation;
  if (normal.size() > 0) {
    deviation = covariance_of(normal).diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FreeParameter& parameter = free[k];
    Estimate estimate;
    estimate.value = parameter.value(u[k]);
    const double half = kTwoSided95 * deviation(static_cast<Eigen::Index>(k));
    const double low = parameter.value(u[k] - half);
    const double high = parameter.value(u[k] + half);
    const bool at_bound = meets(estimate.value, parameter.lower) || meets(estimate.value, parameter.upper);
    bool determined = !at_bound && std::isfinite(half);
    switch (parameter.scale) {
      case FreeParameter::Scale::logarithmic:
        determined = determined && half < std::log(3.0);
        break;
      case FreeParameter::Scale::linear:
        determined = determined && half * parameter.unit_size < size_of(free, u, k);
        break;
      case FreeParameter::Scale::tolerance:
        determined = determined && half < 0.9 * kTwoSided95;
        break;
    }
    if (determined) {
      estimate.interval = {std::min(low, high), std::max(low, high)};
    }
    estimate.pressed = at_bound || (parameter.scale == FreeParameter::Scale::tolerance && std::abs(u[k]) > kFarFromDeclared);
    result.push_back(estimate);
  }
  return result;
}

}  // namespace hotfire::explain
