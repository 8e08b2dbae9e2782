// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/name_beside_signal.hpp"

#include <algorithm>
#include <utility>

#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/latent/locate.hpp"

namespace hotfire::explain {

std::optional<Screened> name_that_saves_most(const Dataset& rows, const Fitted& around, const std::vector<Screened>& laws,
                                             double share, unsigned threads, const Watch& watch) {
  std::vector<Screened> names;
  for (const Screened& law : laws) {
    const bool is_known =
        std::ranges::any_of(names, [&](const Screened& name) { return name.candidate.name == law.candidate.name; });
    if (law.good && !is_known) {
      names.push_back(law);
    }
  }
  const SignalCost alone = cost_of_signal(rows, around, {}, threads);
  parallel_for(names.size(), threads, [&](std::size_t i) {
    names[i].criterion = watch.interrupted() ? alone.cost : cost_of_signal(rows, names[i].fitted, alone.priors, 1).cost;
  });
  const auto best = std::ranges::min_element(names, {}, &Screened::criterion);
  const bool saves = best != names.end() && best->criterion < share * alone.cost;
  return saves ? std::optional(std::move(*best)) : std::nullopt;
}

}  // namespace hotfire::explain
