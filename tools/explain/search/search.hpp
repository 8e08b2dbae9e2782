// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/experiment/next_experiment.hpp"
#include "tools/explain/inference/profile.hpp"
#include "tools/explain/latent/locate.hpp"
#include "tools/explain/refine/screening.hpp"
#include "tools/explain/terms/assessed.hpp"
#include "tools/explain/terms/trial.hpp"

namespace hotfire::explain {

struct SearchResult {
  Assessed declared;
  Assessed calibrated;
  Assessed explained;
  std::vector<Kept> kept;
  std::vector<Trial> trials;
  std::optional<Rival> rival;            ///< of an effect that is kept, the last if that has one
  std::vector<Candidate> not_supported;  ///< effects of the declared model without which the error is the same
  Located located;       ///< where what the explained model is still missing acts; no places where nothing is
  Intervals profiles;    ///< of the explained model's parameters whose error is no parabola
  bool searched = true;  ///< effects were searched for
  bool interrupted = false;

  /// Number of the next round, under which its trials are filed.
  int next_round() const { return trials.empty() ? 1 : trials.back().round + 1; }
};

struct SearchOptions {
  unsigned threads = 1;
  int most_effects = 4;  ///< to add; 0: calibrate only
  Watch watch;
};

/// Calibrates the declared model within its tolerances, then adds effects one by one while the data support them: every
/// candidate is screened, the best are fitted jointly with everything else, and one is kept if it lowers the BIC and the
/// error on held-out blocks. An effect that a later one makes superfluous is taken out again.
/// The first rows of a record whose axis moved before it are taken out of the comparison in `data` (`forget_moving_starts`).
SearchResult search(Dataset& data, const ModelFile& model, const SearchOptions& options);

/// The rows on which candidates are ranked: those of an axis `thinned` to what its servo follows, of other plants all.
Dataset rows_for_ranks(const Dataset& data, const ModelFile& model);

}  // namespace hotfire::explain
