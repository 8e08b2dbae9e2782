// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/latent/locate.hpp"
#include "tools/explain/search/refiner.hpp"
#include "tools/explain/terms/trial.hpp"

namespace hotfire::explain {

/// What terms of unknown law reach, each alone beside a model.
struct UnlistedSearch {
  std::vector<Trial> trials;        ///< the best in screening first; none is kept yet
  std::vector<double> left;         ///< of each beyond noise, over the noise; infinite where it was not fitted jointly
  std::optional<std::size_t> best;  ///< with the least held-out error of those that were fitted jointly
  Assessed model;                   ///< with the best

  /// True if the best is supported and leaves less than this share of that model's held-out error.
  bool leaves_less_than(double share) const;
  /// True if the best leaves no more than noise.
  bool reaches_noise(const Dataset& data) const;
};

/// Screens every term of unknown law that `located` allows beside a model and fits the best jointly with everything else.
/// `round` is what the trials are filed under.
UnlistedSearch search_unlisted(const Dataset& data, const Refiner& refiner, const Assessed& beside, const Located& located,
                               const Scales& scales, unsigned threads, const Watch& watch, int round);

}  // namespace hotfire::explain
