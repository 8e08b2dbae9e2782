// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/refiner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/terms/trial.hpp"

namespace hotfire::explain {

namespace {

/// Places on the way that screening moves what was free before, the whole way first. It is kept unless it leaves more than
/// so many times what another leaves: what little a linear move misses is for the fit.
constexpr std::array kSharesOfMove{1.0, 0.5, 0.25, 0.0};
constexpr double kMovedTooFar = 2.0;

/// Shares of what a known model leaves that the first pass of a fit from elsewhere stays below, or that fit is given up: one
/// that leaves a tenth more is in a worse minimum, and one over a ripple that leaves as much stays in it.
constexpr double kWorseMinimum = 1.1;
constexpr double kOutOfRipple = 0.99;

/// True if rough steps serve: what two models leave of every channel differs by a share of it that steps may change. They
/// are shifted by that change, and what is left of it is the square of a share. A channel that is met to its noise counts
/// with all its rows, and so it must not be lost in the residuals of another that is far off.
bool are_alike(const Evaluator& evaluator, const Eigen::VectorXd& left, const Eigen::VectorXd& other) {
  const std::vector<double> square = evaluator.squares_by_channel(left);
  const std::vector<double> change = evaluator.squares_by_channel(other - left);
  for (std::size_t c = 0; c < square.size(); ++c) {
    if (square[c] > 0.0 && change[c] >= kLostToSteps * kLostToSteps * square[c]) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<Evaluator> Refiner::rough_about(const Fitted& model) const {
  Prediction by_rough;
  Prediction by_coarse;
  if (&rough_ == &coarse_ || !rough_.predict(model.base, model.free, model.u, threads_, by_rough) ||
      !coarse_.predict(model.base, model.free, model.u, threads_, by_coarse) ||
      !are_alike(coarse_, coarse_.residuals(by_coarse), rough_.residuals(by_rough))) {
    return std::nullopt;
  }
  return rough_.shifted(by_rough, by_coarse);
}

Assessed Refiner::ranked(const Fitted& fitted, const Effort& effort, const std::optional<ToBeat>& known) const {
  Effort rest = effort;
  Fitted start = fitted;
  const auto rough = effort.passes > 1 ? rough_about(fitted) : std::nullopt;
  if (rough || known) {
    const Evaluator& first = rough ? *rough : coarse_;
    Assessed near = refined(first, first, threads_, fitted, {effort.iterations, 1, effort.tolerance, effort.slopes});
    if (known &&
        !(near.good() && Goodness::combined(near.goodness.fitted) < known->share * left_by(first, known->model, threads_))) {
      return {};
    }
    if (near.good()) {
      start = std::move(near.model);
      --rest.passes;
    }
  }
  Assessed ended = refined(coarse_, fine_, threads_, std::move(start), rest);
  if (leaves_what_steps_do(data_, ended)) {
    Assessed closer = refined(fine_, fine_, threads_, ended.model, rest);
    ended = better_of(std::move(ended), std::move(closer));
  }
  return with_step_error(std::move(ended));
}

Fitted Refiner::start_of_screened(const Evaluator& evaluator, const Fitted& screened, std::span<const double> frozen) const {
  std::vector<Fitted> starts;
  for (const double share : kSharesOfMove) {
    starts.push_back(screened);
    for (std::size_t k = 0; k < frozen.size(); ++k) {
      starts.back().u[k] = std::lerp(frozen[k], screened.u[k], share);
    }
  }
  if (std::ranges::any_of(screened.free, &FreeParameter::is_ordinate)) {
    starts.push_back(starts.back());
    for (std::size_t k = frozen.size(); k < screened.free.size(); ++k) {
      if (screened.free[k].is_ordinate()) {
        starts.back().u[k] = 0.0;
      }
    }
  }
  Fitted best = screened;
  double least = std::numeric_limits<double>::infinity();
  for (Fitted& start : starts) {
    const double left = left_by(evaluator, start, threads_);
    if (left < least) {
      least = &start == &starts.front() ? left / kMovedTooFar : left;
      best = std::move(start);
    }
  }
  return best;
}

Assessed Refiner::with_step_error(Assessed assessed) const {
  if (coarse_.resolution() != fine_.resolution()) {
    measure_step_error(data_, coarse_, threads_, assessed);
  }
  return assessed;
}

Assessed Refiner::from_declared_values(Assessed fitted) const {
  if (watch_.interrupted()) {
    return fitted;
  }
  Assessed afresh = ranked(with_declared_values(fitted.model), kRanking, ToBeat{fitted.model, kWorseMinimum});
  return better_of(std::move(fitted), std::move(afresh));
}

Assessed Refiner::from_other_starts(int round, Assessed winner, const Candidate& candidate) const {
  // A term of the grammar started where the regression put it.
  if (is_done(winner) || !candidate.choices.empty()) {
    return winner;
  }
  watch_.progress({Work::fitting, fmt::format("round {}: fitting {} from other starts", round, label(candidate)),
                   SharesOfWork::kFittedWithAll});
  if (is_far_from_declared(winner.model)) {
    winner = from_declared_values(std::move(winner));
    if (is_done(winner)) {
      return winner;
    }
  }
  Assessed again = from_other_values(winner, candidate);
  return better_of(std::move(winner), std::move(again));
}

std::vector<OfLaw> Refiner::of_richer_laws(int round, const Assessed& winner, const Candidate& candidate) const {
  std::vector<OfLaw> richer;
  if (is_complete(data_, winner)) {
    return richer;
  }
  const std::size_t own = effect_parameters(winner.model.base, candidate, scales_).size();
  const Fitted rest = without_effect(winner.model, candidate);
  for (const Candidate& law : laws_of(rest.base, data_, candidate)) {
    const std::vector<FreeParameter> parameters = effect_parameters(rest.base, law, scales_);
    if (parameters.size() <= own || watch_.interrupted()) {
      continue;
    }
    watch_.progress({Work::fitting,
                     fmt::format("round {}: fitting {} from where {} ended", round, label(law), label(candidate)),
                     SharesOfWork::kFittedWithAll});
    Fitted start = rest;
    activate(start.base, law);
    for (const FreeParameter& parameter : parameters) {
      start.free.push_back(parameter);
      start.u.push_back(parameter.coordinate(parameter.unit_size));
    }
    Assessed fitted = ranked(start, kCheck);
    if (fitted.good() && criterion_change(fitted, winner, fitted.goodness.fitted) < -policy().strong_evidence) {
      Assessed closer = ranked(fitted.model, kRanking);
      richer.push_back({law, better_of(std::move(fitted), std::move(closer))});
    }
  }
  return richer;
}

Assessed Refiner::by_simplest_law(Assessed winner, Candidate& candidate) const {
  if (!winner.good()) {
    return winner;
  }
  const auto own = effect_parameters(winner.model.base, candidate, scales_);
  const auto estimated = estimates(winner.model.free, winner.model.u, winner.model.normal);
  // A static ratio of 1, the least there can be, is that of a law without one: an interval that reaches so far leaves it
  // open.
  const auto is_open = [&](const FreeParameter& parameter) {
    for (std::size_t k = 0; k < estimated.size(); ++k) {
      if (winner.model.free[k].is_same_as(parameter)) {
        const auto& interval = estimated[k].interval;
        return !interval || interval->first <= parameter.lower || interval->second >= parameter.upper;
      }
    }
    return false;
  };
  for (const Candidate& law : laws_of(winner.model.base, data_, candidate)) {
    const auto fewer = effect_parameters(winner.model.base, law, scales_);
    const auto has = [&](const FreeParameter& parameter) {
      return std::any_of(fewer.begin(), fewer.end(), [&](const FreeParameter& f) { return f.is_same_as(parameter); });
    };
    const bool leaves_out_only_open = std::all_of(
        own.begin(), own.end(), [&](const FreeParameter& parameter) { return has(parameter) || is_open(parameter); });
    if (fewer.size() >= own.size() || !leaves_out_only_open) {
      continue;
    }
    Fitted reduced = winner.model;
    activate(reduced.base, law);
    drop_parameters(reduced, [&](const FreeParameter& parameter) {
      const auto is = [&](const FreeParameter& p) { return p.is_same_as(parameter); };
      return std::any_of(own.begin(), own.end(), is) && !has(parameter);
    });
    Assessed simple = settled(reduced);
    const std::vector<ChannelFit>& effective = winner.goodness.fitted;
    if (simple.good() && criterion_change(simple, winner, effective) <= 0.0) {
      candidate = law;
      return simple;
    }
  }
  return winner;
}

bool Refiner::is_done(const Assessed& winner) const { return is_complete(data_, winner) || watch_.interrupted(); }

Assessed Refiner::without(const Fitted& model, const Candidate& candidate) const {
  Assessed rest = ranked(without_effect(model, candidate), kCheck);
  return rest.good() ? over_ripples(std::move(rest)) : rest;
}

Assessed Refiner::in_place_of(const Fitted& model, const Candidate& candidate, const Candidate& other,
                              const Fitted& tied) const {
  Fitted start = without_effect(model, candidate);
  activate(start.base, other);
  for (std::size_t k = 0; k < tied.free.size(); ++k) {
    if (tied.free[k].is_of_effect(other.effect)) {
      start.free.push_back(tied.free[k]);
      start.u.push_back(tied.u[k]);
    }
  }
  const Assessed near = ranked(start, kRanking);
  return near.good() ? settled(near.model) : near;
}

Screened Refiner::shortly(const Evaluator& evaluator, Screened proposal, std::span<const double> frozen) const {
  Assessed near = refined(evaluator, evaluator, threads_, start_of_screened(evaluator, proposal.fitted, frozen), kGlance);
  const double left = near.good() ? Goodness::combined(near.goodness.fitted) : std::numeric_limits<double>::infinity();
  if (left < proposal.criterion) {
    proposal.criterion = left;
    proposal.fitted = std::move(near.model);
  }
  return proposal;
}

Assessed Refiner::over_ripples(Assessed fitted, double height) const {
  const double left = excess_over_noise(data_, fitted);
  if (left < policy().nothing_left || left >= height || watch_.interrupted()) {
    return fitted;
  }
  Assessed beyond = ranked(fitted.model, kOverRipples, ToBeat{fitted.model, kOutOfRipple});
  if (beyond.good()) {
    beyond = ranked(beyond.model, kRanking);
  }
  return better_of(std::move(fitted), std::move(beyond));
}

Assessed Refiner::from_other_values(const Assessed& winner, const Candidate& candidate) const {
  Fitted anchor = without_effect(winner.model, candidate);
  set_active(anchor.base, candidate.effect, true);
  std::vector<double> own;
  for (std::size_t k = 0; k < winner.model.free.size(); ++k) {
    if (winner.model.free[k].is_of_effect(candidate.effect)) {
      own.push_back(winner.model.u[k]);
    }
  }
  const Evaluator evaluator = for_screening(anchor);
  const Screening screening(evaluator, anchor, scales_, threads_);
  const Screened again = screening.restart(candidate, own, watch_);
  return again.good
             ? ranked(start_of_screened(coarse_, again.fitted, anchor.u), kRanking, ToBeat{winner.model, kWorseMinimum})
             : Assessed{};
}

}  // namespace hotfire::explain
