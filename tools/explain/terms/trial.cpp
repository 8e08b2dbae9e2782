// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/trial.hpp"

#include <algorithm>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

std::vector<std::string> sites_of(const Kept& kept) {
  std::vector<std::string> sites{kept.trial.candidate.site};
  for (const Trial& other : kept.alternatives) {
    if (other.decision == "tied" && std::ranges::find(sites, other.candidate.site) == sites.end()) {
      sites.push_back(other.candidate.site);
    }
  }
  return sites;
}

std::string label(const Candidate& candidate) {
  return candidate.option_name.empty() ? candidate.name : candidate.name + " (" + candidate.option_name + ")";
}

bool is_supported(const Trial& trial) {
  return trial.delta_criterion < -policy().strong_evidence && trial.held_out_ratio < 1.0 - policy().least_held_out_drop;
}

bool is_as_good(const Trial& trial) {
  return trial.delta_criterion < policy().strong_evidence && trial.held_out_ratio < 1.0 + policy().least_held_out_drop;
}

std::string reason_of(const Trial& trial, const Trial* best) {
  if (trial.decision == "kept") {
    return words::lowers(1.0 - trial.held_out_ratio, -trial.delta_criterion);
  }
  if (trial.decision == "tied") {
    return words::is_tied(label(best->candidate), trial.delta_criterion - best->delta_criterion);
  }
  if (!trial.screened) {
    return std::string(words::text(words::Reason::not_screened));
  }
  if (!trial.refined) {
    return std::string(words::text(trial.delta_criterion > -policy().strong_evidence ? words::Reason::no_lower_criterion
                                                                                     : words::Reason::behind_finalists));
  }
  if (best != &trial && best->delta_criterion < trial.delta_criterion) {
    return words::is_better(label(best->candidate), trial.delta_criterion - best->delta_criterion);
  }
  return words::changes_too_little(trial.held_out_ratio - 1.0, trial.delta_criterion);
}

}  // namespace hotfire::explain
