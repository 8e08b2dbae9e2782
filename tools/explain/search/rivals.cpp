// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/watch.hpp"

namespace hotfire::explain {

namespace {

/// True if what is kept contains the rival already: the other effect, or the other law of the same effect.
bool is_in(const std::vector<Kept>& kept, const Rival& rival) {
  return std::ranges::any_of(kept, [&](const Kept& k) {
    return rival.other.effect == rival.kept.effect ? label(k.trial.candidate) == label(rival.other)
                                                   : k.trial.candidate.effect == rival.other.effect;
  });
}

/// Makes the alternative that has this label the trial that is kept.
void swap_with_alternative(Kept& kept, const std::string& other, const Candidate& before) {
  const auto alternative =
      std::ranges::find_if(kept.alternatives, [&](const Trial& trial) { return label(trial.candidate) == other; });
  if (alternative != kept.alternatives.end()) {
    std::swap(kept.trial, *alternative);
    kept.trial.decision = "kept";
    alternative->decision = "dropped";
    alternative->candidate = before;
  }
}

}  // namespace

void give_law(SearchResult& result, Candidate& candidate, OfLaw other, int round, words::LawChange why) {
  if (!other.model.good()) {
    return;
  }
  Trial trial{round, other.candidate, true, 0.0, 1.0, 0.0, "kept", words::text(why, label(candidate))};
  compare(trial, other.model, result.explained, other.model.goodness.fitted);
  result.trials.push_back(std::move(trial));
  candidate = other.candidate;
  result.explained = std::move(other.model);
}

void Rivals::set_aside() {
  if (result_.rival) {
    aside_.push_back(std::move(*result_.rival));
    result_.rival.reset();
  }
}

void Rivals::compare_again() {
  for (const Rival& rival : std::exchange(aside_, {})) {
    compare_again(rival);
  }
}

void Rivals::compare_again(const Rival& rival) {
  const auto kept =
      std::ranges::find_if(result_.kept, [&](const Kept& k) { return k.trial.candidate.effect == rival.kept.effect; });
  if (kept == result_.kept.end() || is_in(result_.kept, rival) || watch_.interrupted()) {
    return;
  }
  Candidate& candidate = kept->trial.candidate;
  watch_.progress({Work::settling, fmt::format("is {} still as good as {}", label(rival.other), label(candidate))});
  Assessed with = refiner_.in_place_of(result_.explained.model, candidate, rival.other, rival.model);
  if (!with.good()) {
    return;
  }
  const int round = result_.trials.back().round;
  Trial trial{round, rival.other, true, 0.0, 1.0, 0.0, "dropped", ""};
  compare(trial, with, result_.explained, with.goodness.fitted);
  if (is_supported(trial)) {
    give_law(result_, candidate, {rival.other, std::move(with)}, round, words::LawChange::rival_better);
    swap_with_alternative(*kept, label(rival.other), rival.kept);
    // What tied with the last effect was fitted beside the one that is out now.
    result_.rival.reset();
    return;
  }
  if (trial.delta_criterion < policy().strong_evidence) {
    trial.decision = "tied";
    trial.reason = words::text(words::LawChange::rival_tied, label(candidate));
    if (!result_.rival) {
      result_.rival = Rival{candidate, rival.other, std::move(with.model)};
    }
  } else {
    trial.reason = words::text(words::LawChange::rival_separated, label(candidate));
  }
  result_.trials.push_back(std::move(trial));
}

}  // namespace hotfire::explain
