// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/term_constant.hpp"

#include <algorithm>
#include <cmath>

#include "tools/explain/inference/zero_shift.hpp"
#include "tools/explain/terms/table_points.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// A constant that is given is known to this share of the curve.
constexpr double kGiven = 1e-3;
/// A change of the constant by which the readings at rest are differentiated, over the curve.
constexpr double kSmallOfCurve = 1e-3;
/// A constant that would have to be larger, over the curve, moves hardly anything at rest.
constexpr double kMostOfCurve = 10.0;

/// The largest ordinate of a term's table; nothing if it has no points.
double largest_ordinate(const ModelParameters& parameters, const Candidate& candidate) {
  double largest = 0.0;
  visit_table(parameters, candidate, [&]<class>(const auto&, const auto& table) {
    for (int i = 0; i < table.points; ++i) {
      largest = std::max(largest, std::abs(table.y[static_cast<std::size_t>(i)]));
    }
  });
  return largest;
}

void raise(ModelParameters& parameters, const Candidate& candidate, double by) {
  visit_table(parameters, candidate, [&]<class>(const auto&, auto& table) {
    std::for_each_n(table.y.begin(), table.points, [by](double& y) { y += by; });
  });
}

double value_at_zero(const ModelParameters& parameters, const Candidate& candidate) {
  double value = 0.0;
  visit_table(parameters, candidate, [&]<class>(const auto&, const auto& table) {
    value = model::curve_value<double>(table.x, table.y, static_cast<std::size_t>(table.points), 0.0);
  });
  return value;
}

/// The constant with which the records have the least zeros; nothing if the readings at rest do not move with it. `small`:
/// a change of it by which they are differentiated.
std::optional<double> constant_of_least_zeros(const Dataset& data, const Zeros& zeros, const ModelParameters& plant,
                                              const Candidate& candidate, double small) {
  ModelParameters raised = plant;
  raise(raised, candidate, small);
  const double step = data.experiments.front().period;
  const auto shift = shift_at_rest(std::get<SimplexParameters>(plant), std::get<SimplexParameters>(raised), small, step);
  return common_shift(data, zeros, shift).amount;
}

}  // namespace

std::optional<Fitted> with_chosen_constant(const Dataset& data, const Zeros& zeros, const Fitted& fitted,
                                           const Candidate& candidate) {
  const ModelParameters plant = fitted.parameters();
  const double size = largest_ordinate(plant, candidate);
  if (!(size > 0.0) || is_oscillator(candidate)) {
    return std::nullopt;
  }
  const std::optional<double> constant = forgets_constants(candidate)
                                             ? -value_at_zero(plant, candidate)
                                             : constant_of_least_zeros(data, zeros, plant, candidate, kSmallOfCurve * size);
  if (!constant || !(std::abs(*constant) <= kMostOfCurve * size)) {
    return std::nullopt;
  }
  Fitted moved = fitted;
  raise(moved.base, candidate, *constant);
  Eigen::VectorXd of_mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(moved.free.size()));
  double ordinates = 0.0;
  for (std::size_t k = 0; k < moved.free.size(); ++k) {
    const FreeParameter& p = moved.free[k];
    if (p.is_of_effect(candidate.effect) && p.is_ordinate()) {
      moved.u[k] = p.coordinate(std::clamp(p.value(moved.u[k]) + *constant, p.lower, p.upper));
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
