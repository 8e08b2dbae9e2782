#include "tools/explain/unlisted_search.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/explain/finalists.hpp"
#include "tools/explain/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// Sets how a term of unknown law does against the calibrated model, and says so.
template <class Family>
void compare_and_say(Trial& trial, const Assessed<Family>& with, const Assessed<Family>& calibrated) {
  compare(trial, with, calibrated, with.goodness.fitted);
  trial.reason = fmt::format("leaves {:.1f} % of the calibrated model's held-out error", 100.0 * trial.held_out_ratio);
}

}  // namespace

template <class Family>
bool UnlistedSearch<Family>::leaves_less_than(double share) const {
  return best && trials[*best].delta_criterion < -kStrongEvidence && trials[*best].held_out_ratio < share;
}

template <class Family>
UnlistedSearch<Family> search_unlisted(const Dataset& data, const Refiner<Family>& refiner,
                                       const Assessed<Family>& calibrated, const Scales& scales, unsigned threads,
                                       const Watch& watch, int round) {
  const Fitted<Family> around =
      is_within_tolerances(calibrated.model) ? calibrated.model : with_declared_values(calibrated.model);
  const Evaluator<Family> evaluator = refiner.for_screening(around);
  const Screening<Family> screening(evaluator, around, scales, threads);
  const auto screened = screening.run(unlisted_candidates<Family>(data), "unlisted", watch);
  const std::size_t wanted = unlisted_finalists(screened);
  UnlistedSearch<Family> result;
  for (const Screened<Family>& s : screened) {
    Trial trial{round, s.candidate, false, s.criterion, 1.0, s.seconds, "dropped", "behind the finalists in screening"};
    if (result.trials.size() < wanted && !watch.interrupted()) {
      watch.progress(fmt::format("unlisted: fitting {} with everything else", label(s.candidate)));
      Assessed<Family> finalist = refiner.of_screened(s.fitted, around.u);
      if (finalist.good()) {
        compare_and_say(trial, finalist, calibrated);
        if (!result.best || trial.held_out_ratio < result.trials[*result.best].held_out_ratio) {
          result.best = result.trials.size();
          result.model = std::move(finalist);
        }
      }
    }
    result.trials.push_back(std::move(trial));
  }
  if (result.best) {
    Assessed<Family> settled = refiner.settled(result.model.model);
    if (settled.good()) {
      compare_and_say(result.trials[*result.best], settled, calibrated);
      result.model = std::move(settled);
    }
  }
  return result;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                                \
  template struct UnlistedSearch<Family>;                                                                          \
  template UnlistedSearch<Family> search_unlisted(const Dataset&, const Refiner<Family>&, const Assessed<Family>&, \
                                                  const Scales&, unsigned, const Watch&, int);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
