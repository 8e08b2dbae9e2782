// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/declared_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/explain/refine/finalists.hpp"

namespace hotfire::explain {

std::vector<Candidate> effects_without_support(const Dataset& data, const Refiner& refiner, const ModelParameters& declared,
                                               const Assessed& explained, const Watch& watch) {
  const std::vector<Candidate> every = all_candidates(declared, data);
  std::vector<Candidate> unsupported;
  for (const Candidate& candidate : every) {
    if (!has_law(declared, candidate) || watch.interrupted()) {
      continue;
    }
    ModelParameters others = declared;
    set_active(others, candidate.effect, false);
    const bool is_needed = std::ranges::any_of(every, [&](const Candidate& other) {
      return is_active(others, other.effect) && !has_what_it_carries(others, other);
    });
    if (is_needed) {
      continue;
    }
    watch.progress({Work::concluding, fmt::format("do the records support the declared {}", label(candidate))});
    const Assessed rest = refiner.without(explained.model, candidate);
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

}  // namespace hotfire::explain
