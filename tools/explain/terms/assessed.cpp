// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/assessed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Change of the logarithm of a temper below which it has converged.
constexpr double kTemperStands = 0.2;
/// A fit that ran out of iterations goes on where its last pass left less than this share of the error.
constexpr double kStillFalling = 0.95;

/// Error of a step over what half of it changes, at first order: a slip starts within a step.
constexpr double kErrorOfSteps = 2.0;

/// Knows then what the steps of `other`, longer ones, change of a prediction.
void compare_with_longer(const Dataset& data, const Evaluator& other, const Prediction& by_other, Assessed& assessed) {
  if (assessed.good()) {
    assessed.by_longer =
        difference_over_noise(other.data(), at_thinned_rows(assessed.prediction, data, other.data()), by_other);
  }
}

}  // namespace

double left_by(const Evaluator& evaluator, const Fitted& model, unsigned threads) {
  Prediction prediction;
  return evaluator.predict(model.base, model.free, model.u, threads, prediction)
             ? Goodness::combined(goodness(evaluator.data(), prediction).fitted)
             : std::numeric_limits<double>::infinity();
}

Assessed assess(const Evaluator& fine, unsigned threads, const Fitted& fitted) {
  Assessed assessed{fitted, {}, {}};
  fine.predict(fitted.base, fitted.free, fitted.u, threads, assessed.prediction, assessed.zeros);
  assessed.goodness = goodness(fine.data(), assessed.prediction);
  return assessed;
}

Assessed refined(const Evaluator& evaluator, const Evaluator& fine, unsigned threads, Fitted fitted, const Effort& effort) {
  Assessed failed;
  failed.model.base = fitted.base;
  Prediction prediction;
  if (!evaluator.predict(fitted.base, fitted.free, fitted.u, threads, prediction)) {
    return failed;
  }
  fitted.temper = temper_of(evaluator, evaluator.residuals(prediction));
  double left = Goodness::combined(goodness(evaluator.data(), prediction).fitted);
  // A temper weighs the residuals and changes none of their derivatives.
  const FitOptions options{effort.iterations, threads, effort.tolerance, effort.slopes, nullptr};
  Tangent tangent = tangent_of(evaluator, fitted, options);
  for (int pass = 0; pass < effort.passes; ++pass) {
    if (!fit(evaluator, fitted, options, tangent) ||
        !evaluator.predict(fitted.base, fitted.free, fitted.u, threads, prediction)) {
      return failed;
    }
    const Temper next = temper_of(evaluator, evaluator.residuals(prediction));
    double change = 0.0;
    for (std::size_t c = 0; c < next.size(); ++c) {
      change = std::max(change, std::abs(std::log(next[c] / fitted.temper[c])));
    }
    fitted.temper = next;
    if (tangent.slopes() == Slopes::wide) {
      tangent.forget();  // they say something of the ripples that they were taken over, and of no others
    }
    const double before = std::exchange(left, Goodness::combined(goodness(evaluator.data(), prediction).fitted));
    if (change < kTemperStands && (fitted.converged || left > kStillFalling * before)) {
      break;
    }
  }
  Assessed assessed = assess(fine, threads, fitted);
  if (&evaluator != &fine) {
    compare_with_longer(fine.data(), evaluator, prediction, assessed);
  }
  return assessed;
}

bool leaves_what_steps_do(const Dataset& data, const Assessed& assessed) {
  for (std::size_t c = 0; c < assessed.by_longer.size(); ++c) {
    if (!data.used[c] || assessed.by_longer[c] <= kLostToSteps * policy().immaterial) {
      continue;
    }
    const double left = excess_over_noise(data, assessed.prediction, c);
    if (left > policy().immaterial && assessed.by_longer[c] > kLostToSteps * left) {
      return true;
    }
  }
  return false;
}

void measure_step_error(const Dataset& data, const Evaluator& coarse, unsigned threads, Assessed& assessed) {
  const Fitted& model = assessed.model;
  Prediction other;
  const bool is_new =
      assessed.good() && assessed.by_longer.empty() && excess_over_noise(data, assessed.prediction) > policy().immaterial;
  if (is_new && coarse.predict(model.base, model.free, model.u, threads, other)) {
    compare_with_longer(data, coarse, other, assessed);
  }
  if (leaves_what_steps_do(data, assessed) &&
      Evaluator(data, Resolution::finest).predict(model.base, model.free, model.u, threads, other)) {
    assessed.step_error = difference_over_noise(data, assessed.prediction, other);
  }
}

double excess_over_noise(const Dataset& data, const Assessed& assessed) {
  if (assessed.step_error.empty()) {
    return excess_over_noise(data, assessed.prediction);
  }
  double largest = 0.0;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (data.used[c]) {
      const double left = excess_over_noise(data, assessed.prediction, c);
      const double of_steps = kErrorOfSteps * assessed.step_error[c];
      largest = std::max(largest, std::sqrt(std::max(0.0, left * left - of_steps * of_steps)));
    }
  }
  return largest;
}

bool reaches_noise(const Dataset& data, const Assessed& assessed) {
  return excess_over_noise(data, assessed) <= (assessed.model.chaotic ? policy().chaotic : policy().immaterial);
}

Moved farthest_from_declared(const Fitted& model) {
  Moved farthest;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    const double tolerances = std::abs(model.free[k].surprise(model.u[k]));
    if (model.free[k].is_declared() && tolerances > farthest.tolerances) {
      farthest = {model.free[k].key, tolerances};
    }
  }
  return farthest;
}

bool is_within_tolerances(const Fitted& model) {
  return farthest_from_declared(model).tolerances <= policy().farthest_from_declared;
}

bool is_complete(const Dataset& data, const Assessed& assessed) {
  return reaches_noise(data, assessed) && is_within_tolerances(assessed.model);
}

bool compensates(const Dataset& data, const Assessed& assessed) {
  return reaches_noise(data, assessed) && !is_within_tolerances(assessed.model);
}

bool is_more_credible(const Dataset& data, const Assessed& model, const Assessed& than) {
  return compensates(data, than) && is_complete(data, model) &&
         criterion_change(model, than, model.goodness.fitted) <
             prior_cost(than.model.free, than.model.u) - prior_cost(model.model.free, model.model.u);
}

Fitted without_effect(const Fitted& model, const Candidate& candidate) {
  Fitted rest = model;
  rest.base = rest.parameters();
  set_active(rest.base, candidate.effect, false);
  drop_parameters(rest, [&](const FreeParameter& parameter) { return parameter.is_of_effect(candidate.effect); });
  return rest;
}

Fitted with_declared_values(Fitted model) {
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k].is_declared()) {
      model.u[k] = 0.0;
    }
  }
  return model;
}

bool is_far_from_declared(const Fitted& model) {
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

Assessed better_of(Assessed first, Assessed second) {
  const bool better =
      second.good() && Goodness::combined(second.goodness.fitted) < Goodness::combined(first.goodness.fitted);
  return better ? std::move(second) : std::move(first);
}

double criterion_change(const Assessed& with, const Assessed& without, const std::vector<ChannelFit>& effective) {
  return information_criterion(with.goodness.fitted, effective, with.model.free.size()) -
         information_criterion(without.goodness.fitted, effective, without.model.free.size());
}

double held_out_ratio(const Assessed& with, const Assessed& without) {
  return error_ratio(with.goodness.held_out, without.goodness.held_out);
}

bool leaves_clearly_more(const Assessed& one, const Assessed& other) {
  const double more = 1.0 / (policy().clearly_less * policy().clearly_less);
  const auto is_no_more = [&](const ChannelFit& left, const ChannelFit& by_other) {
    return left.mean_square <= more * by_other.mean_square;
  };
  return !std::ranges::equal(one.goodness.held_out, other.goodness.held_out, is_no_more);
}

bool held_out_rows_contain_more(const Assessed& model) {
  return std::ranges::any_of(model.goodness.held_out, [](const ChannelFit& channel) {
    return channel.mean_square - 1.0 > policy().visible * policy().visible;
  });
}

bool held_out_rows_agree(const Assessed& with, const Assessed& without) {
  const bool must_confirm = held_out_rows_contain_more(without) || !is_within_tolerances(without.model);
  return held_out_ratio(with, without) < (must_confirm ? policy().held_out_less : 1.0 + policy().least_held_out_drop);
}

}  // namespace hotfire::explain
