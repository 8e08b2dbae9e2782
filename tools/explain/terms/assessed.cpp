// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/assessed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Change of the logarithm of a temper below which it has converged.
constexpr double kTemperStands = 0.2;
/// A fit that ran out of iterations goes on where its last pass left less than this share of the error.
constexpr double kStillFalling = 0.95;

}  // namespace

template <class Family>
Assessed<Family> assess(const Evaluator<Family>& fine, unsigned threads, const Fitted<Family>& fitted) {
  Assessed<Family> assessed{fitted, {}, {}};
  fine.predict(fitted.base, fitted.free, fitted.u, threads, assessed.prediction, assessed.zeros);
  assessed.goodness = goodness(fine.data(), assessed.prediction);
  return assessed;
}

template <class Family>
Assessed<Family> refined(const Evaluator<Family>& evaluator, const Evaluator<Family>& fine, unsigned threads,
                         Fitted<Family> fitted, const Effort& effort) {
  Prediction prediction;
  if (!evaluator.predict(fitted.base, fitted.free, fitted.u, threads, prediction)) {
    return {};
  }
  fitted.temper = temper_of<Family>(evaluator, evaluator.residuals(prediction));
  double left = Goodness::combined(goodness(evaluator.data(), prediction).fitted);
  for (int pass = 0; pass < effort.passes; ++pass) {
    if (!fit(evaluator, fitted, {effort.iterations, threads, effort.tolerance, effort.slopes, nullptr}) ||
        !evaluator.predict(fitted.base, fitted.free, fitted.u, threads, prediction)) {
      return {};
    }
    const Temper next = temper_of<Family>(evaluator, evaluator.residuals(prediction));
    double change = 0.0;
    for (std::size_t c = 0; c < next.size(); ++c) {
      change = std::max(change, std::abs(std::log(next[c] / fitted.temper[c])));
    }
    fitted.temper = next;
    const double before = std::exchange(left, Goodness::combined(goodness(evaluator.data(), prediction).fitted));
    if (change < kTemperStands && (fitted.converged || left > kStillFalling * before)) {
      break;
    }
  }
  return assess(fine, threads, fitted);
}

template <class Family>
bool reaches_noise(const Dataset& data, const Assessed<Family>& assessed) {
  return excess_over_noise(data, assessed.prediction) <= (assessed.model.chaotic ? policy().chaotic : policy().immaterial);
}

template <class Family>
Moved farthest_from_declared(const Fitted<Family>& model) {
  Moved farthest;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    const double tolerances = std::abs(model.free[k].surprise(model.u[k]));
    if (model.free[k].is_declared() && tolerances > farthest.tolerances) {
      farthest = {model.free[k].key, tolerances};
    }
  }
  return farthest;
}

template <class Family>
bool is_within_tolerances(const Fitted<Family>& model) {
  return farthest_from_declared(model).tolerances <= policy().farthest_from_declared;
}

template <class Family>
bool is_complete(const Dataset& data, const Assessed<Family>& assessed) {
  return reaches_noise(data, assessed) && is_within_tolerances(assessed.model);
}

template <class Family>
Fitted<Family> without_effect(const Fitted<Family>& model, const Candidate& candidate) {
  Fitted<Family> rest = model;
  rest.base = Evaluator<Family>::with_values(rest.base, rest.free, rest.u);
  rest.base.effects.active[candidate.effect] = false;
  drop_parameters(rest, [&](const FreeParameter& parameter) { return parameter.is_of_effect(candidate.effect); });
  return rest;
}

template <class Family>
Fitted<Family> with_declared_values(Fitted<Family> model) {
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k].is_declared()) {
      model.u[k] = 0.0;
    }
  }
  return model;
}

template <class Family>
bool is_far_from_declared(const Fitted<Family>& model) {
  double count = 0.0;
  double square = 0.0;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k].is_declared()) {
      count += 1.0;
      square += model.free[k].surprise(model.u[k]) * model.free[k].surprise(model.u[k]);
    }
  }
  return square > count;
}

template <class Family>
Assessed<Family> better_of(Assessed<Family> first, Assessed<Family> second) {
  const bool better =
      second.good() && Goodness::combined(second.goodness.fitted) < Goodness::combined(first.goodness.fitted);
  return better ? std::move(second) : std::move(first);
}

template <class Family>
double criterion_change(const Assessed<Family>& with, const Assessed<Family>& without,
                        const std::vector<ChannelFit>& effective) {
  return information_criterion(with.goodness.fitted, effective, with.model.free.size()) -
         information_criterion(without.goodness.fitted, effective, without.model.free.size());
}

template <class Family>
double held_out_ratio(const Assessed<Family>& with, const Assessed<Family>& without) {
  return error_ratio(with.goodness.held_out, without.goodness.held_out);
}

#define HOTFIRE_INSTANTIATE(Family)                                                                                   \
  template Assessed<Family> assess(const Evaluator<Family>&, unsigned, const Fitted<Family>&);                        \
  template Assessed<Family> refined(const Evaluator<Family>&, const Evaluator<Family>&, unsigned, Fitted<Family>,     \
                                    const Effort&);                                                                   \
  template bool reaches_noise(const Dataset&, const Assessed<Family>&);                                               \
  template Moved farthest_from_declared(const Fitted<Family>&);                                                       \
  template bool is_within_tolerances(const Fitted<Family>&);                                                          \
  template bool is_complete(const Dataset&, const Assessed<Family>&);                                                 \
  template Fitted<Family> without_effect(const Fitted<Family>&, const Candidate&);                                    \
  template Fitted<Family> with_declared_values(Fitted<Family>);                                                       \
  template bool is_far_from_declared(const Fitted<Family>&);                                                          \
  template Assessed<Family> better_of(Assessed<Family>, Assessed<Family>);                                            \
  template double criterion_change(const Assessed<Family>&, const Assessed<Family>&, const std::vector<ChannelFit>&); \
  template double held_out_ratio(const Assessed<Family>&, const Assessed<Family>&);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
