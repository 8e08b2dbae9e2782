// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/round.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/refine/watch.hpp"

namespace hotfire::explain {

namespace {

/// True if a trial ranks before another: by the BIC, but one that held-out data do not support never before one that they
/// do.
bool is_before(const Trial& one, const Trial& other) {
  return is_supported(one) == is_supported(other) ? one.delta_criterion < other.delta_criterion : is_supported(one);
}

}  // namespace

void refuse(std::span<Trial> of_round, std::string_view why) {
  const auto best = std::ranges::find(of_round, "kept", &Trial::decision);
  if (best != of_round.end()) {
    best->decision = "dropped";
    best->reason = words::leaves(best->held_out_ratio) + std::string(why);
  }
}

Round::Round(int number, const Dataset& data, const Refiner& refiner, const Assessed& current,
             std::vector<Screened> screened, const Watch& watch)
    : number_(number),
      data_(data),
      refiner_(refiner),
      current_(current),
      screened_(std::move(screened)),
      watch_(watch),
      finalists_(screened_.size()),
      order_(finalists_of(screened_)) {
  for (const Screened& s : screened_) {
    trials_.push_back({number_, s.candidate, false, s.criterion, 1.0, s.seconds, "dropped", "", s.scanned});
  }
}

RoundResult Round::run(std::optional<words::Reason> unless_complete) {
  fit_finalists();
  rank();
  if (watch_.interrupted()) {
    return undecided();
  }
  if (best_ && clears_up(finalists_[*best_])) {
    leave_local_minima();
    rank();
  }
  RoundResult result;
  if (best_ && clears_up(finalists_[*best_])) {
    finalists_[*best_] = refiner_.from_other_starts(number_, std::move(finalists_[*best_]), trials_[*best_].candidate);
    add_richer_laws();
    rank();
    result.settled = is_near_noise(*best_);
    result.model = winner();
  }
  const bool kept =
      best_ && result.model.good() && is_supported(trials_[*best_]) && is_worth_a_name(trials_[*best_], result.model);
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const bool is_tied = kept && trials_[i].refined &&
                         trials_[i].delta_criterion - trials_[*best_].delta_criterion < policy().strong_evidence;
    trials_[i].decision = kept && i == *best_ ? "kept" : is_tied ? "tied" : "dropped";
    trials_[i].reason = reason_of(trials_[i], best_ ? &trials_[*best_] : nullptr);
  }
  result.trials = trials_;
  if (kept && unless_complete && !is_complete(data_, result.model)) {
    refuse(result.trials, words::text(*unless_complete));
  } else if (kept) {
    result.kept = Kept{trials_[*best_], trials_};
    std::vector<Trial>& others = result.kept->alternatives;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(*best_));
    std::stable_sort(others.begin(), others.end(),
                     [](const Trial& a, const Trial& b) { return a.delta_criterion < b.delta_criterion; });
    result.rival = rival_of(*result.kept);
  }
  return result;
}

/// False where what is left is of the noise's size already and a further effect takes away little of it: it then imitates
/// how the laws that were found differ from the truth's.
bool Round::clears_up(const Assessed& with) const {
  const double before = excess_over_noise(data_, current_);
  const double after = excess_over_noise(data_, with);
  return before > policy().visible || after * after < policy().clearly_less * before * before;
}

bool Round::is_worth_a_name(const Trial& trial, const Assessed& with) const {
  return trial.held_out_ratio < policy().hardly_less || excess_over_noise(data_, with) < policy().near_noise;
}

/// True if a finalist that is fitted already leaves no more than noise, and is either a simpler law of the same effect or
/// another effect that promised more than twice as much.
bool Round::is_decided_against(std::size_t wanted) const {
  return std::any_of(order_.begin(), order_.end(), [&](std::size_t i) {
    if (!finalists_[i].good() || excess_over_noise(data_, finalists_[i].prediction) >= policy().nothing_left) {
      return false;
    }
    return screened_[i].candidate.name == screened_[wanted].candidate.name
               ? screened_[i].fitted.free.size() < screened_[wanted].fitted.free.size()
               : screened_[wanted].criterion > 0.5 * screened_[i].criterion;
  });
}

bool Round::is_near_noise(std::size_t finalist) const {
  return excess_over_noise(data_, finalists_[finalist]) < policy().near_noise;
}

void Round::fit_finalists() {
  const auto finalists = simplest_laws_first(order_, screened_);
  for (std::size_t k = 0; k < finalists.size() && !watch_.interrupted(); ++k) {
    const std::size_t i = finalists[k];
    if (is_decided_against(i)) {
      continue;
    }
    report_progress("with everything else", i,
                    std::lerp(SharesOfWork::kFittedAlone, SharesOfWork::kFittedWithAll,
                              static_cast<double>(k) / static_cast<double>(finalists.size())));
    const Stopwatch stopwatch;
    finalists_[i] = refiner_.of_screened(screened_[i].fitted, current_.model.u);
    trials_[i].seconds += stopwatch.seconds();
  }
}

/// Fits those that may yet be the best from elsewhere. Two candidates that are nearly as good are not compared by the local
/// minimum that one of them is in: all that is wrong with it may be a declared parameter that the last round moved.
void Round::leave_local_minima() {
  const bool is_at_noise = reaches_noise(data_, finalists_[*best_]);
  for (const std::size_t i : contenders_of(order_, screened_, finalists_)) {
    const Stopwatch stopwatch;
    if (!is_at_noise) {
      report_progress("over ripples", i, SharesOfWork::kFittedWithAll);
      finalists_[i] = refiner_.over_ripples(std::move(finalists_[i]));
    }
    if (is_near_noise(i) && excess_over_noise(data_, finalists_[i]) >= policy().nothing_left) {
      report_progress("from the declared values", i, SharesOfWork::kFittedWithAll);
      finalists_[i] = refiner_.from_declared_values(std::move(finalists_[i]));
    }
    trials_[i].seconds += stopwatch.seconds();
  }
}

/// Puts among the finalists the laws of the best one's effect that have more parameters, from where it ended.
void Round::add_richer_laws() {
  for (OfLaw& richer : refiner_.of_richer_laws(number_, finalists_[*best_], screened_[*best_].candidate)) {
    for (std::size_t i = 0; i < screened_.size(); ++i) {
      if (label(screened_[i].candidate) != label(richer.candidate)) {
        continue;
      }
      if (finalists_[i].good()) {
        finalists_[i] = better_of(std::move(finalists_[i]), std::move(richer.model));
      } else {
        finalists_[i] = std::move(richer.model);
        order_.push_back(i);
      }
    }
  }
}

/// Sets how every finalist does, all on the effective samples of the one with the least error: a model that leaves a
/// coloured residual must not set the price of a parameter.
void Round::rank() {
  std::optional<std::size_t> closest;
  for (const std::size_t i : order_) {
    if (finalists_[i].good() && (!closest || Goodness::combined(finalists_[i].goodness.fitted) <
                                                 Goodness::combined(finalists_[*closest].goodness.fitted))) {
      closest = i;
    }
  }
  best_.reset();
  for (const std::size_t i : order_) {
    if (finalists_[i].good()) {
      compare(trials_[i], finalists_[i], current_, finalists_[*closest].goodness.fitted);
      if (!best_ || is_before(trials_[i], trials_[*best_])) {
        best_ = i;
      }
    }
  }
}

/// The best finalist, by the simplest of its laws and under fine steps where it may be the last, with which all others are
/// compared once more. One that is not supported as it was ranked rarely is under fine steps: a short fit is enough.
Assessed Round::winner() {
  Assessed winner = finalists_[*best_];
  if (is_near_noise(*best_)) {
    report_progress("with fine steps", *best_, SharesOfWork::kFittedWithAll);
    if (!is_supported(trials_[*best_])) {
      winner = refiner_.settled(winner.model, kCheck);
      if (winner.good()) {
        compare(trials_[*best_], winner, current_, winner.goodness.fitted);
      }
    }
    if (winner.good() && is_supported(trials_[*best_])) {
      winner = refiner_.by_simplest_law(refiner_.settled(winner.model), trials_[*best_].candidate);
    }
  }
  for (const std::size_t i : order_) {
    const Assessed& finalist = i == *best_ ? winner : finalists_[i];
    if (winner.good() && finalist.good()) {
      compare(trials_[i], finalist, current_, winner.goodness.fitted);
    }
  }
  return winner;
}

/// What was known of every candidate when the search was interrupted.
RoundResult Round::undecided() {
  for (Trial& trial : trials_) {
    trial.decision = kUndecided;
    trial.reason = words::text(trial.refined    ? words::Reason::interrupted_refined
                               : trial.screened ? words::Reason::interrupted_screened
                                                : words::Reason::interrupted_before);
  }
  RoundResult result;
  result.trials = trials_;
  return result;
}

/// The closest of the other finalists, fitted as well as the winner was, if the data do not separate the two.
std::optional<Rival> Round::rival_of(const Kept& kept) const {
  for (const Trial& other : kept.alternatives) {
    if (!other.refined || other.delta_criterion - kept.trial.delta_criterion >= policy().strong_evidence) {
      continue;
    }
    for (std::size_t i = 0; i < screened_.size(); ++i) {
      if (label(screened_[i].candidate) == label(other.candidate) && finalists_[i].good()) {
        const Assessed again = refiner_.settled(finalists_[i].model);
        return again.good() ? std::optional(Rival{kept.trial.candidate, other.candidate, again.model}) : std::nullopt;
      }
    }
  }
  return std::nullopt;
}

void Round::report_progress(const std::string& what, std::size_t finalist, double share) const {
  watch_.progress(
      {Work::fitting, fmt::format("round {}: fitting {} {}", number_, label(screened_[finalist].candidate), what), share});
}

}  // namespace hotfire::explain
