// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/unlisted_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/explain/data/measured_load.hpp"
#include "tools/explain/inference/veto.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/explain/search/term_proposals.hpp"
#include "tools/explain/terms/periodic.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

namespace {

/// Sets how a term of unknown law does against the model that it is tried beside, and says so.
void compare_and_say(Trial& trial, const Assessed& with, const Assessed& beside) {
  compare(trial, with, beside, with.goodness.fitted);
  trial.reason =
      held_out_rows_contain_more(beside) ? words::leaves(trial.held_out_ratio) : words::leaves_noise(trial.held_out_ratio);
}

/// Terms of the grammar that are fitted jointly, of those that were proposed: one of every site, or two of one.
constexpr std::size_t kTermFinalists = 2;
/// Forms of every site that are fitted shortly.
constexpr std::size_t kFittedOfSite = 3;
/// Held signals of which the periods near their own are tried.
constexpr std::size_t kClocks = 4;
/// Finalists in the place of those that something speaks against.
constexpr std::size_t kReplaced = 4;

/// True if a term on a signal makes it fall where it is asked to rise. No amplifier and no valve does: such a table imitates
/// something that it does not depend on, and an axis that meets it beyond these records sticks where it falls.
bool falls_as_it_rises(const Fitted& model, const Candidate& candidate) {
  const auto table = table_of(model.parameters(), candidate);
  if (!table || table->x_name != "value") {
    return false;
  }
  std::vector<double> signal;
  std::ranges::transform(table->x, table->y, std::back_inserter(signal), std::plus<>());
  const auto [low, high] = std::ranges::minmax(signal);
  const double flat = policy().scatter * (high - low);
  return std::ranges::adjacent_find(signal, [&](double here, double next) { return next < here - flat; }) != signal.end();
}

/// Puts what leaves least first, the best of every site before all others: which site it is the fits decide.
void order_by_site(std::vector<Screened>& proposals) {
  std::ranges::stable_sort(proposals, {}, [](const auto& proposal) { return proposal.criterion; });
  std::vector<std::string> sites;
  std::stable_partition(proposals.begin(), proposals.end(), [&](const auto& proposal) {
    const bool is_first = std::ranges::find(sites, proposal.candidate.site) == sites.end();
    if (is_first) {
      sites.push_back(proposal.candidate.site);
    }
    return is_first;
  });
}

/// Proposed terms in the order of what they leave, simulated: the order of a linear regression is often wrong near its top.
std::vector<Screened> by_simulation(const UnlistedTask& task, const Evaluator& evaluator, const Fitted& around,
                                    const std::vector<ScoredForm>& proposals, double without) {
  std::vector<Screened> starts;
  for (const ScoredForm& proposed : proposals) {
    if (task.watch.interrupted()) {
      break;
    }
    if (auto start = best_start(evaluator, around, proposed, task.scales, without, task.threads)) {
      starts.push_back(std::move(*start));
    }
  }
  order_by_site(starts);
  return starts;
}

bool is_held(const Screened& proposal) { return proposal.candidate.option == static_cast<int>(model::Memory::hold); }

/// A held signal with the periods near its own.
struct Clock {
  Screened* held = nullptr;
  std::vector<Refiner::OfPeriod> periods;
};

/// The held signals whose samples are fitted: of those that replace a signal and those that leave least, at every site the
/// one that leaves least at any period near its own.
std::vector<Clock> clocks_of(const UnlistedTask& task, const Evaluator& evaluator, std::vector<Screened>& proposals) {
  std::vector<Screened*> held;
  for (Screened& proposal : proposals) {
    if (is_held(proposal)) {
      held.push_back(&proposal);
    }
  }
  std::ranges::stable_sort(held, {}, [](const Screened* s) { return std::pair(!s->replaces, s->criterion); });
  held.resize(std::min(held.size(), kClocks));
  std::vector<Clock> clocks;
  for (Screened* proposal : held) {
    Clock clock{proposal, task.refiner.over_periods(evaluator, *proposal)};
    if (task.watch.interrupted()) {
      break;
    }
    const auto of_site = std::ranges::find_if(
        clocks, [&](const Clock& other) { return other.held->candidate.site == proposal->candidate.site; });
    if (of_site == clocks.end()) {
      clocks.push_back(std::move(clock));
    } else if (clock.periods.front().least < of_site->periods.front().least) {
      *of_site = std::move(clock);
    }
  }
  return clocks;
}

/// A short fit of the best forms of every site: where the effect is large, what a form leaves before any fit says little of
/// what it can explain. Of the held signals one of every site is fitted with its samples. The others try the samples of the
/// one that leaves least: a rig has one clock.
void fit_best_shortly(const UnlistedTask& task, const Evaluator& evaluator, std::span<const double> frozen,
                      std::vector<Screened>& proposals) {
  const auto fit = [&](Screened& proposal, auto&& fitted) {
    task.watch.progress(
        {Work::unlisted, fmt::format("unlisted: a short fit of {}", label(proposal.candidate)), SharesOfWork::kProposed});
    const Stopwatch stopwatch;
    const double seconds = proposal.seconds;
    proposal = fitted();
    proposal.seconds = seconds + stopwatch.seconds();
  };
  std::vector<Clock> clocks = clocks_of(task, evaluator, proposals);
  for (Clock& clock : clocks) {
    if (!task.watch.interrupted()) {
      fit(*clock.held, [&] { return task.refiner.with_samples(evaluator, std::move(clock.periods), frozen); });
    }
  }
  const auto best = std::ranges::min_element(clocks, {}, [](const Clock& clock) { return clock.held->criterion; });
  std::map<std::string, std::size_t> of_site;
  for (Screened& proposal : proposals) {
    if (std::ranges::find(clocks, &proposal, &Clock::held) != clocks.end() ||
        of_site[proposal.candidate.site]++ >= kFittedOfSite || task.watch.interrupted()) {
      continue;
    }
    fit(proposal, [&] {
      return is_held(proposal) ? task.refiner.with_samples_of(evaluator, *best->held, std::move(proposal), frozen)
                               : task.refiner.shortly(evaluator, std::move(proposal), frozen);
    });
  }
  order_by_site(proposals);
}

/// How many of them are fitted: one of every site, and two at least.
std::size_t terms_to_fit(const std::vector<Screened>& proposals) {
  std::set<std::string> sites;
  for (const auto& proposal : proposals) {
    sites.insert(proposal.candidate.site);
  }
  return std::max(kTermFinalists, sites.size());
}

/// What speaks against a term although it explains much; empty if nothing.
std::string objection(const UnlistedTask& task, const Assessed& with, const Candidate& candidate) {
  if (falls_as_it_rises(with.model, candidate)) {
    return std::string(words::text(words::Reason::falls_as_it_rises));
  }
  if (feeds_energy(with.model.parameters(), candidate)) {
    return std::string(words::text(words::Reason::feeds_energy));
  }
  const std::string harm = harm_of(task.data, with.prediction, task.calibrated);
  return harm.empty() ? std::string() : "; " + words::refused(harm);
}

/// A term that was fitted with everything else.
struct Finalist {
  Assessed model;
  double left = std::numeric_limits<double>::infinity();  ///< beyond noise, over the noise
  std::string against;                                    ///< what speaks against it; empty if nothing
};

/// Fits what was screened with everything else and judges it. `trial` says how it does.
Finalist fit_finalist(const UnlistedTask& task, std::span<const double> frozen, const Screened& screened, Trial& trial) {
  Finalist finalist;
  finalist.model = is_held(screened) ? task.refiner.of_held(screened, frozen, kCheck)
                                     : task.refiner.of_screened(screened.fitted, frozen, kCheck);
  if (!finalist.model.good()) {
    return finalist;
  }
  const auto judge = [&] {
    compare_and_say(trial, finalist.model, task.beside);
    finalist.left = excess_over_noise(task.data, finalist.model.prediction);
    finalist.against = objection(task, finalist.model, screened.candidate);
  };
  judge();
  // A fit that ends early leaves some of what it would explain in the channel that it counts least.
  if (!finalist.against.empty() && trial.held_out_ratio < policy().clearly_less && !task.watch.interrupted()) {
    if (Assessed settled = task.refiner.settled(finalist.model.model); settled.good()) {
      finalist.model = std::move(settled);
      judge();
    }
  }
  trial.reason += finalist.against;
  return finalist;
}

/// Fits the first of what was screened with everything else, until there are `most` that nothing speaks against, and files
/// all of them. Those behind one that leaves no more than noise are not fitted: they promised less. Those that the screening
/// left with clearly more than the best one are not fitted either.
void fit_finalists(const UnlistedTask& task, std::span<const double> frozen, const std::vector<Screened>& screened,
                   std::size_t most, UnlistedSearch& result) {
  std::size_t to_fit = most;
  std::size_t may_replace = kReplaced;
  std::optional<double> least;  // that the screening left of the best one
  for (const Screened& s : screened) {
    Trial trial{task.round, s.candidate, false,     s.criterion,
                1.0,        s.seconds,   "dropped", std::string(words::text(words::Reason::behind_finalists))};
    Finalist finalist;
    const bool is_decided =
        result.reaches_noise(task.data) && s.candidate.site == result.trials[*result.best].candidate.site;
    const bool is_behind = least && *least < policy().clearly_less * s.left;
    const bool has_turn = to_fit > 0 && !is_decided && !task.watch.interrupted();
    to_fit -= has_turn ? 1 : 0;
    if (has_turn && !is_behind) {
      task.watch.progress({Work::unlisted, fmt::format("unlisted: fitting {} with everything else", label(s.candidate)),
                           SharesOfWork::kProposed});
      const Stopwatch stopwatch;
      finalist = fit_finalist(task, frozen, s, trial);
      trial.seconds += stopwatch.seconds();
    }
    const bool is_best = finalist.model.good() && finalist.against.empty() &&
                         (!result.best || trial.held_out_ratio < result.trials[*result.best].held_out_ratio);
    if (is_best) {
      result.best = result.trials.size();
      result.model = std::move(finalist.model);
      least = s.left;
    } else if (!finalist.against.empty() && may_replace > 0) {
      ++to_fit;
      --may_replace;
    }
    result.trials.push_back(std::move(trial));
    result.left.push_back(finalist.left);
  }
}

/// Terms of the grammar: proposed by regression, simulated, fitted shortly, and the best of every site fitted jointly.
void fit_terms_of_grammar(const UnlistedTask& task, const Fitted& around, const Evaluator& evaluator,
                          UnlistedSearch& result) {
  const double without = left_by(evaluator, around, task.threads);
  std::vector<Screened> proposals = by_simulation(
      task, evaluator, around, propose_terms(evaluator.data(), around, task.located, task.threads, task.watch), without);
  fit_best_shortly(task, evaluator, around.u, proposals);
  std::ranges::for_each(proposals, [&](Screened& proposal) { proposal.left = proposal.criterion / without; });
  fit_finalists(task, around.u, proposals, terms_to_fit(proposals), result);
}

/// Tables and short laws at the sites of the task, where no effect is active and no load is measured.
void fit_tables(const UnlistedTask& task, const Fitted& around, const Evaluator& evaluator, UnlistedSearch& result) {
  const Screening screening(evaluator, around, task.scales, task.threads);
  std::vector<Candidate> candidates = unlisted_candidates(around.base, task.data);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return is_active(around.base, candidate.effect) || !task.located.allows(candidate.site) ||
           is_measured_load(task.data, candidate.site);
  });
  Watch of_unlisted = task.watch;
  of_unlisted.progress = [&task](Doing doing) {
    doing.work = Work::unlisted;
    task.watch.progress(doing);
  };
  const auto screened = screening.run(candidates, "unlisted", of_unlisted);
  fit_finalists(task, around.u, screened, unlisted_finalists(screened), result);
}

/// The best term with everything free, and with one phase for all records where it is periodic and this is no worse.
void settle_best(const UnlistedTask& task, UnlistedSearch& result) {
  Trial& best = result.trials[*result.best];
  Assessed settled = task.refiner.settled(result.model.model);
  if (settled.good()) {
    compare_and_say(best, settled, task.beside);
    result.model = std::move(settled);
  }
  // A memory that the records do not need imitates what the regression makes of the plant.
  if (const auto plain = without_memory(result.model.model, best.candidate, task.scales)) {
    Assessed simple = task.refiner.settled(plain->fitted);
    if (simple.good() && criterion_change(simple, result.model, result.model.goodness.fitted) <= 0.0 &&
        held_out_ratio(simple, result.model) < 1.0 + policy().least_held_out_drop) {
      best.candidate = plain->candidate;
      compare_and_say(best, simple, task.beside);
      result.model = std::move(simple);
    }
  }
  if (is_periodic(best.candidate)) {
    Assessed common = task.refiner.settled(with_common_phase(task.data, result.model.model, best.candidate));
    if (common.good() && criterion_change(common, result.model, result.model.goodness.fitted) <= 0.0) {
      compare_and_say(best, common, task.beside);
      result.model = std::move(common);
    }
  }
}

}  // namespace

void UnlistedSearch::add(UnlistedSearch other) {
  if (other.best && (!best || other.trials[*other.best].held_out_ratio < trials[*best].held_out_ratio)) {
    best = trials.size() + *other.best;
    model = std::move(other.model);
  }
  std::ranges::move(other.trials, std::back_inserter(trials));
  left.insert(left.end(), other.left.begin(), other.left.end());
}

void UnlistedSearch::mark_tied_sites() {
  if (!best) {
    return;
  }
  const double most = std::max(policy().visible, left[*best] / policy().clearly_less);
  // Near the noise every term leaves little: one that has less than half of the evidence is no equal.
  const double weakest = policy().little_explained * trials[*best].delta_criterion;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (left[i] < most && trials[i].delta_criterion < weakest && trials[i].candidate.site != trials[*best].candidate.site) {
      trials[i].decision = "tied";
      trials[i].reason += words::text(words::Reason::tied_site);
    }
  }
}

bool UnlistedSearch::has_evidence() const { return best && trials[*best].delta_criterion < -policy().strong_evidence; }

bool UnlistedSearch::leaves_less_than(double share) const { return has_evidence() && trials[*best].held_out_ratio < share; }

bool UnlistedSearch::leaves_material(const Dataset& data) const {
  return !best || excess_over_noise(data, model.prediction) > policy().immaterial;
}

bool UnlistedSearch::reaches_noise(const Dataset& data) const {
  return best && excess_over_noise(data, model.prediction) < policy().nothing_left;
}

UnlistedSearch search_unlisted(const UnlistedTask& task) {
  const Fitted around =
      is_within_tolerances(task.beside.model) ? task.beside.model : with_declared_values(task.beside.model);
  const Evaluator evaluator = task.refiner.for_screening(around);
  UnlistedSearch result;
  if (is_hydraulic_axis(around.base)) {
    fit_terms_of_grammar(task, around, evaluator, result);
  }
  // A law that somebody has named is one more hypothesis as long as what the grammar leaves is not immaterial.
  if (task.tables && result.leaves_material(task.data)) {
    fit_tables(task, around, evaluator, result);
  }
  if (result.best) {
    settle_best(task, result);
  }
  return result;
}

}  // namespace hotfire::explain
