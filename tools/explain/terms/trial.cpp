#include "tools/explain/terms/trial.hpp"

#include <fmt/format.h>

#include <algorithm>

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
  return trial.delta_criterion < -kStrongEvidence && trial.held_out_ratio < 1.0 - kLeastHeldOutDrop;
}

bool is_as_good(const Trial& trial) {
  return trial.delta_criterion < kStrongEvidence && trial.held_out_ratio < 1.0 + kLeastHeldOutDrop;
}

std::string reason_of(const Trial& trial, const Trial* best) {
  if (trial.decision == "kept") {
    return fmt::format("lowers the held-out error by {:.1f} % and the BIC by {:.0f}", 100.0 * (1.0 - trial.held_out_ratio),
                       -trial.delta_criterion);
  }
  if (trial.decision == "tied") {
    return fmt::format("the data do not tell it from {}: {:+.1f} in BIC", label(best->candidate),
                       trial.delta_criterion - best->delta_criterion);
  }
  if (!trial.screened) {
    return "not fitted: none of the laws that it contains goes on";
  }
  if (!trial.refined) {
    return trial.delta_criterion > -kStrongEvidence ? "does not lower the BIC" : "behind the finalists in screening";
  }
  if (best != &trial && best->delta_criterion < trial.delta_criterion) {
    return fmt::format("{} is better by {:.0f} in BIC", label(best->candidate),
                       trial.delta_criterion - best->delta_criterion);
  }
  return fmt::format("changes the held-out error by {:+.2f} % and the BIC by {:+.0f}: too little",
                     100.0 * (trial.held_out_ratio - 1.0), trial.delta_criterion);
}

}  // namespace hotfire::explain
