// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/declared_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/explain/search/finalists.hpp"

namespace hotfire::explain {

template <class Family>
std::vector<Candidate> effects_without_support(const Dataset& data, const Refiner<Family>& refiner,
                                               const PlainParameters<Family>& declared, const Assessed<Family>& explained,
                                               const Watch& watch) {
  const std::vector<Candidate> every = all_candidates<Family>(data);
  std::vector<Candidate> unsupported;
  for (const Candidate& candidate : every) {
    if (!has_law<Family>(declared, candidate) || watch.interrupted()) {
      continue;
    }
    PlainParameters<Family> others = declared;
    others.effects.active[candidate.effect] = false;
    const bool is_needed = std::ranges::any_of(every, [&](const Candidate& other) {
      return others.effects.active[other.effect] && !has_what_it_carries<Family>(others, other);
    });
    if (is_needed) {
      continue;
    }
    watch.progress(fmt::format("do the records support the declared {}", label(candidate)));
    const Assessed<Family> rest = refiner.without(explained.model, candidate);
    Trial trial{0, candidate, true, 0.0, 1.0, 0.0, "", ""};
    if (rest.good()) {
      compare(trial, rest, explained, rest.goodness.fitted);
      if (is_as_good(trial)) {
        unsupported.push_back(candidate);
      }
    }
  }
  return unsupported;
}

#define HOTFIRE_INSTANTIATE(Family)                        \
  template std::vector<Candidate> effects_without_support( \
      const Dataset&, const Refiner<Family>&, const PlainParameters<Family>&, const Assessed<Family>&, const Watch&)
HOTFIRE_INSTANTIATE(SimplexFamily);
HOTFIRE_INSTANTIATE(DirectFamily);
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
