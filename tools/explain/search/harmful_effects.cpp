// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/harmful_effects.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "tools/explain/inference/veto.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

namespace {

/// The effect to take out, by its place, and the model without it.
std::pair<std::size_t, Assessed> without_harm(const Dataset& data, const Refiner& refiner, const SearchResult& result) {
  if (result.kept.size() == 1) {
    return {0, result.calibrated};
  }
  std::optional<std::pair<std::size_t, Assessed>> best;
  for (std::size_t i = 0; i < result.kept.size(); ++i) {
    Assessed rest = refiner.without(result.explained.model, result.kept[i].trial.candidate);
    const bool is_last = i + 1 == result.kept.size();
    const bool is_harmless = rest.good() && harm_of(data, rest.prediction, result.calibrated.prediction).empty();
    const bool leaves_least =
        !best || Goodness::combined(rest.goodness.held_out) < Goodness::combined(best->second.goodness.held_out);
    if (is_harmless ? leaves_least : is_last && !best) {
      best = {i, std::move(rest)};
    }
  }
  return std::move(*best);
}

}  // namespace

bool take_out_harmful(const Dataset& data, const Refiner& refiner, const Watch& watch, SearchResult& result) {
  bool any = false;
  while (!result.kept.empty() && !watch.interrupted()) {
    const std::string harm = harm_of(data, result.explained.prediction, result.calibrated.prediction);
    if (harm.empty()) {
      break;
    }
    any = true;
    watch.progress({Work::settling, "what was found is worse than the calibrated model: " + harm});
    auto [out, rest] = without_harm(data, refiner, result);
    const Kept taken = std::move(result.kept[out]);
    result.kept.erase(result.kept.begin() + static_cast<std::ptrdiff_t>(out));
    Trial trial{result.next_round(), taken.trial.candidate, true, 0.0, 1.0, 0.0, "taken out", words::refused(harm)};
    if (!rest.good()) {
      rest = result.calibrated;
      result.kept.clear();
    }
    compare(trial, rest, result.explained, rest.goodness.fitted);
    result.trials.push_back(std::move(trial));
    result.rival.reset();
    result.explained = std::move(rest);
  }
  return any;
}

}  // namespace hotfire::explain
