#include "tools/explain/search/unlisted_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "tools/explain/search/finalists.hpp"
#include "tools/explain/terms/periodic.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// Sets how a term of unknown law does against the model that it is tried beside, and says so.
template <class Family>
void compare_and_say(Trial& trial, const Assessed<Family>& with, const Assessed<Family>& beside) {
  compare(trial, with, beside, with.goodness.fitted);
  trial.reason = fmt::format("leaves {:.1f} % of the held-out error", 100.0 * trial.held_out_ratio);
}

/// A signal that falls by less than this share of its range where it should rise is flat, as in a dead band.
constexpr double kFlat = 0.05;

/// True if a term on a signal makes it fall where it is asked to rise. No amplifier and no valve does: such a table imitates
/// something that it does not depend on, and an axis that meets it beyond these records sticks where it falls.
template <class Family>
bool falls_as_it_rises(const Fitted<Family>& model, const Candidate& candidate) {
  const auto table = table_of<Family>(Evaluator<Family>::with_values(model.base, model.free, model.u), candidate);
  if (!table || table->x_name != "value") {
    return false;
  }
  std::vector<double> signal;
  std::ranges::transform(table->x, table->y, std::back_inserter(signal), std::plus<>());
  const auto [low, high] = std::ranges::minmax(signal);
  const double flat = kFlat * (high - low);
  return std::ranges::adjacent_find(signal, [&](double here, double next) { return next < here - flat; }) != signal.end();
}

}  // namespace

template <class Family>
bool UnlistedSearch<Family>::leaves_less_than(double share) const {
  return best && trials[*best].delta_criterion < -kStrongEvidence && trials[*best].held_out_ratio < share;
}

template <class Family>
UnlistedSearch<Family> search_unlisted(const Dataset& data, const Refiner<Family>& refiner, const Assessed<Family>& beside,
                                       const Located& located, const Scales& scales, unsigned threads, const Watch& watch,
                                       int round) {
  const Fitted<Family> around = is_within_tolerances(beside.model) ? beside.model : with_declared_values(beside.model);
  const Evaluator<Family> evaluator = refiner.for_screening(around);
  const Screening<Family> screening(evaluator, around, scales, threads);
  std::vector<Candidate> candidates = unlisted_candidates<Family>(data);
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return around.base.effects.active[candidate.effect] || !located.allows(candidate.site);
  });
  const auto screened = screening.run(candidates, "unlisted", watch);
  const std::size_t wanted = unlisted_finalists(screened);
  UnlistedSearch<Family> result;
  for (const Screened<Family>& s : screened) {
    Trial trial{round, s.candidate, false, s.criterion, 1.0, s.seconds, "dropped", "behind the finalists in screening"};
    if (result.trials.size() < wanted && !watch.interrupted()) {
      watch.progress(fmt::format("unlisted: fitting {} with everything else", label(s.candidate)));
      Assessed<Family> finalist = refiner.of_screened(s.fitted, around.u);
      if (finalist.good()) {
        compare_and_say(trial, finalist, beside);
        if (falls_as_it_rises(finalist.model, s.candidate)) {
          trial.reason += ", but by a signal that falls where it should rise";
        } else if (!result.best || trial.held_out_ratio < result.trials[*result.best].held_out_ratio) {
          result.best = result.trials.size();
          result.model = std::move(finalist);
        }
      }
    }
    result.trials.push_back(std::move(trial));
  }
  if (result.best) {
    Trial& best = result.trials[*result.best];
    Assessed<Family> settled = refiner.settled(result.model.model);
    if (settled.good()) {
      compare_and_say(best, settled, beside);
      result.model = std::move(settled);
    }
    if (is_periodic(best.candidate)) {
      Assessed<Family> common = refiner.settled(with_common_phase(data, result.model.model, best.candidate));
      if (common.good() && criterion_change(common, result.model, result.model.goodness.fitted) <= 0.0) {
        compare_and_say(best, common, beside);
        result.model = std::move(common);
      }
    }
  }
  return result;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                                \
  template struct UnlistedSearch<Family>;                                                                          \
  template UnlistedSearch<Family> search_unlisted(const Dataset&, const Refiner<Family>&, const Assessed<Family>&, \
                                                  const Located&, const Scales&, unsigned, const Watch&, int);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
