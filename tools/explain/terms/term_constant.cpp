// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/term_constant.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/explain/terms/table_points.hpp"

namespace hotfire::explain {

namespace {

/// A constant that is given is known to this share of the curve.
constexpr double kGiven = 1e-3;

/// The largest ordinate of a term's table; nothing if it has no points.
double largest_ordinate(const PlainParameters<SimplexFamily>& parameters, const Candidate& candidate) {
  double largest = 0.0;
  visit_table(parameters, candidate, [&]<class>(const auto&, const auto& table) {
    for (int i = 0; i < table.points; ++i) {
      largest = std::max(largest, std::abs(table.y[static_cast<std::size_t>(i)]));
    }
  });
  return largest;
}

void raise(PlainParameters<SimplexFamily>& parameters, const Candidate& candidate, double by) {
  visit_table(parameters, candidate, [&]<class>(const auto&, auto& table) {
    std::for_each_n(table.y.begin(), table.points, [by](double& y) { y += by; });
  });
}

/// What each reading of an axis at rest moves by for a unit of the constant.
std::array<double, 3> shift_at_rest(const PlainParameters<SimplexFamily>& parameters, const Candidate& candidate,
                                    double size, double step) {
  constexpr double kSmall = 1e-3;
  PlainParameters<SimplexFamily> raised = parameters;
  raise(raised, candidate, kSmall * size);
  const model::Simplex<double> plain(parameters, step);
  const model::Simplex<double> other(raised, step);
  const std::array<double, 3> before = plain.measured(plain.steady(0.0));
  std::array<double, 3> shift = other.measured(other.steady(0.0));
  for (std::size_t c = 0; c < shift.size(); ++c) {
    shift[c] = (shift[c] - before[c]) / (kSmall * size);
  }
  return shift;
}

}  // namespace

Fitted<SimplexFamily> with_least_zeros(const Dataset& data, const Zeros& zeros, const Fitted<SimplexFamily>& fitted,
                                       const Candidate& candidate) {
  const PlainParameters<SimplexFamily> plant = Evaluator<SimplexFamily>::with_values(fitted.base, fitted.free, fitted.u);
  const double size = largest_ordinate(plant, candidate);
  if (!(size > 0.0)) {
    return fitted;
  }
  const std::array<double, 3> shift = shift_at_rest(plant, candidate, size, data.experiments.front().period);
  double product = 0.0;
  double square = 0.0;
  for (std::size_t e = 0; e < zeros.size(); ++e) {
    for (std::size_t c = 0; c < shift.size(); ++c) {
      const Experiment& experiment = data.experiments[e];
      if (!experiment.measured[c].empty() && experiment.zero_deviation[c] > 0.0) {
        const double of_constant = shift[c] / experiment.zero_deviation[c];
        product += of_constant * zeros[e][c] / experiment.zero_deviation[c];
        square += of_constant * of_constant;
      }
    }
  }
  // Beyond that a constant moves hardly anything at rest.
  constexpr double kMostOfCurve = 10.0;
  const double constant = square > 0.0 ? product / square : 0.0;
  if (!(std::abs(constant) <= kMostOfCurve * size)) {
    return fitted;
  }
  Fitted<SimplexFamily> moved = fitted;
  raise(moved.base, candidate, constant);
  Eigen::VectorXd of_mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(moved.free.size()));
  double ordinates = 0.0;
  for (std::size_t k = 0; k < moved.free.size(); ++k) {
    const FreeParameter& p = moved.free[k];
    if (p.is_of_effect(candidate.effect) && p.is_ordinate()) {
      moved.u[k] = p.coordinate(std::clamp(p.value(moved.u[k]) + constant, p.lower, p.upper));
      of_mean(static_cast<Eigen::Index>(k)) = p.unit_size;
      ordinates += 1.0;
    }
  }
  if (ordinates > 0.0 && moved.normal.rows() == of_mean.size()) {
    of_mean /= ordinates * kGiven * size;
    moved.normal += of_mean * of_mean.transpose();
  }
  return moved;
}

}  // namespace hotfire::explain
