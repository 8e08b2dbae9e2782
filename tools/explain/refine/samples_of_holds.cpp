// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/terms/visit_term.hpp"

namespace hotfire::explain {

namespace {

/// How many rows the period of a hold may be off from where the regression has it.
constexpr int kPeriodOff = 4;
/// The periods near that one that are fitted, of those that leave least as proposed.
constexpr std::size_t kPeriodsFitted = 3;
/// How many rows the samples may be off: at a period that is not fitted, and at one that is.
constexpr int kInstantsOff = 2;
constexpr int kSamplesOff = 2;
/// Turns in which samples and all else are fitted under fine steps.
constexpr int kTurns = 3;
/// Where beside a row they are tried: a logger that is in step with them reads before or after the sample.
constexpr double kBesideRow = 0.02;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// The shortest row of the data.
double shortest_row(const Dataset& data) { return std::ranges::min(data.experiments, {}, &Experiment::period).period; }

/// When a held term samples, in rows.
struct Samples {
  double rows = 2.0;    ///< of a period
  double passed = 0.0;  ///< of it at the start of a record
};

Samples samples_of(const Screened& held, double row) {
  Samples samples;
  visit_term(held.fitted.base, held.candidate, [&](const auto& term) {
    samples.rows = std::max(2.0, std::round(term.time / row));
    samples.passed = samples.rows * term.phase / kTurn;
  });
  return samples;
}

void set_samples(Screened& held, const Samples& samples, double row) {
  visit_term(held.fitted.base, held.candidate, [&](auto& term) {
    term.time = samples.rows * row;
    term.phase = std::remainder(kTurn * samples.passed / samples.rows, kTurn);
  });
}

void keep_better(Screened tried, Screened& best) {
  if (tried.criterion < best.criterion) {
    best = std::move(tried);
  }
}

}  // namespace

Screened Refiner::with_samples_at(const Evaluator& evaluator, Screened held, double rows, double passed) const {
  set_samples(held, {rows, passed}, shortest_row(data_));
  held.criterion = left_by(evaluator, held.fitted, threads_);
  return held;
}

/// A held term with its samples at the best of the instants up to `off` rows from where they are.
Screened Refiner::at_best_instant(const Evaluator& evaluator, const Screened& held, int off) const {
  const Samples own = samples_of(held, shortest_row(data_));
  Screened best = held;
  for (int early = -off; early <= off && !watch_.interrupted(); ++early) {
    for (const double part : {-kBesideRow, kBesideRow, 0.5}) {
      keep_better(with_samples_at(evaluator, held, own.rows, std::round(own.passed) + early + part), best);
    }
  }
  return best;
}

std::vector<Refiner::OfPeriod> Refiner::over_periods(const Evaluator& evaluator, const Screened& held) const {
  const Samples proposed = samples_of(held, shortest_row(data_));
  std::vector<OfPeriod> periods;
  for (int longer = -kPeriodOff; longer <= kPeriodOff && !watch_.interrupted(); ++longer) {
    const double rows = proposed.rows + longer;
    if (rows >= 2.0) {
      Screened moved = with_samples_at(evaluator, held, rows, proposed.passed * rows / proposed.rows);
      Screened best = at_best_instant(evaluator, moved, held.replaces ? static_cast<int>(rows) / 2 : kInstantsOff);
      const double least = best.criterion;
      periods.push_back({std::move(held.replaces ? best : moved), least});
    }
  }
  std::ranges::stable_sort(periods, {}, &OfPeriod::least);
  return periods;
}

Screened Refiner::with_samples(const Evaluator& evaluator, std::vector<OfPeriod> periods,
                               std::span<const double> frozen) const {
  periods.resize(std::min(periods.size(), kPeriodsFitted));
  std::optional<Screened> best;
  for (OfPeriod& period : periods) {
    if (best && watch_.interrupted()) {
      break;
    }
    // From the samples as proposed: a fit from those that suit a gain that is too small moves the declared parameters.
    Screened fitted = at_best_instant(evaluator, shortly(evaluator, std::move(period.proposed), frozen), kSamplesOff);
    if (!best || fitted.criterion < best->criterion) {
      best = std::move(fitted);
    }
  }
  return watch_.interrupted() ? std::move(*best) : shortly(evaluator, std::move(*best), frozen);
}

Assessed Refiner::of_held(const Screened& screened, std::span<const double> frozen, const Effort& effort) const {
  Assessed best;
  Screened held = screened;
  for (int turn = 0; turn < kTurns && !watch_.interrupted(); ++turn) {
    const Samples before = samples_of(held, shortest_row(data_));
    held.criterion = left_by(fine_, held.fitted, threads_);
    held = at_best_instant(fine_, held, kSamplesOff);
    const bool is_same = samples_of(held, shortest_row(data_)).passed == before.passed;
    if (turn > 0 && is_same) {
      break;
    }
    Assessed fitted = turn == 0 ? of_screened(held.fitted, frozen, effort) : ranked(held.fitted, effort);
    best = best.good() ? better_of(std::move(best), std::move(fitted)) : std::move(fitted);
    if (!best.good()) {
      break;
    }
    held.fitted = best.model;
  }
  return best;
}

Screened Refiner::with_samples_of(const Evaluator& evaluator, const Screened& other, Screened held,
                                  std::span<const double> frozen) const {
  const double row = shortest_row(data_);
  const auto of_own_fit = [&](Screened fitted) {
    fitted.criterion = left_by(evaluator, fitted.fitted, threads_);
    return shortly(evaluator, std::move(fitted), frozen);
  };
  Screened moved = held;
  set_samples(moved, samples_of(other, row), row);
  held = of_own_fit(std::move(held));
  keep_better(of_own_fit(std::move(moved)), held);
  return held;
}

}  // namespace hotfire::explain
