// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/explain/latent/latent_input.hpp"

namespace hotfire::explain {

/// A place where an unknown signal may act, and what it explains there. No signal separates its sites: a law
/// decides between them.
struct Place {
  std::vector<std::string> sites;  ///< "load_spring", "structure"
  double gain = 0.0;               ///< log likelihood with the most likely signal less that without any
  std::vector<double> leaves;  ///< by channel: mean square over noise of what the signal leaves; empty: far from the best
  bool is_possible = false;    ///< it leaves as little as the best: a law may act here, which costs less than a signal
  bool is_likely = false;      ///< ... and no other place explains clearly more
  LatentPlace where{};
  LatentPrior prior{};  ///< of the most likely signal

  bool has(const std::string& site) const;
};

/// Where the term acts that a model is missing.
struct Located {
  std::vector<Place>
      places;  ///< likely ones first, each by its gain; empty where nothing is missing or the model could not be simulated
  bool is_single = false;  ///< one signal at a likely place leaves noise alone

  /// False if a term at `site` cannot be what is missing.
  bool allows(const std::string& site) const;
  /// True if one signal explains the records, and no law at `site` can be what is missing. `found`: the sites of the effects
  /// that were found. What one of them leaves of its own law acts at its own site, and refutes no other.
  bool refutes(const std::string& site, const std::vector<std::string>& found) const;
  /// True if what is missing may act at `site`: no signal at another place explains clearly more.
  bool may_act_at(const std::string& site) const;
  /// The sites of all likely places.
  std::vector<std::string> likely_sites() const;
  /// The same with every place where a signal leaves as little as at the best, likely or not.
  Located opened() const;
  /// The same with no place likely but the best.
  Located only_best() const;
  /// The same with only those places likely that are so here and not in `other`, place by place.
  Located beyond(const Located& other) const;
};

/// Tries an unknown signal at every place beside a fitted model. It knows no law: which place explains most is decided by
/// the likelihood of the records alone. Records of more than 32,000 rows together are thinned to as many: the filter keeps
/// about a kilobyte a row.
Located locate(const Dataset& data, const Fitted& around, unsigned threads);

/// What one unknown signal costs beside a model.
struct SignalCost {
  /// How much less likely the records are than noise alone would be, with the signal at the place where it is most likely,
  /// in log likelihood. A small or slow signal costs little. Infinite if the model cannot be simulated.
  double cost = std::numeric_limits<double>::infinity();
  std::vector<LatentPrior> priors;  ///< the most likely signal of each place
};

/// The cost of an unknown signal. Records of more than 4,000 rows together are thinned to as many. `near`: the priors beside
/// another model, from which those beside this one are found in a third of the time; empty if there are none.
SignalCost cost_of_signal(const Dataset& data, const Fitted& around, const std::vector<LatentPrior>& near, unsigned threads);

}  // namespace hotfire::explain
