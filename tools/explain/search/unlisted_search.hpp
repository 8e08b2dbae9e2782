// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/latent/locate.hpp"
#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/terms/trial.hpp"

namespace hotfire::explain {

/// What terms of unknown law reach, each alone beside a model.
struct UnlistedSearch {
  std::vector<Trial> trials;        ///< the best in screening first; none is kept yet
  std::vector<double> left;         ///< of each beyond noise, over the noise; infinite where it was not fitted jointly
  std::optional<std::size_t> best;  ///< with the least held-out error of those that nothing speaks against
  Assessed model;                   ///< with the best

  /// Adds what a search at other places reached; the best of both is the best.
  void add(UnlistedSearch other);
  /// Marks the terms at other sites that the records do not separate from the best.
  void mark_tied_sites();
  /// True if the fitted rows speak for the best.
  bool has_evidence() const;
  /// True if they do, and the best leaves less than this share of that model's held-out error.
  bool leaves_less_than(double share) const;
  /// True if what the best leaves is not immaterial.
  bool leaves_material(const Dataset& data) const;
  /// True if the best leaves no more than noise.
  bool reaches_noise(const Dataset& data) const;
};

/// What a search for a term of unknown law is based on.
struct UnlistedTask {
  const Dataset& data;
  const Refiner& refiner;
  const Assessed& beside;        ///< the model that each term is tried beside
  const Prediction& calibrated;  ///< of the calibrated model, for the veto
  const Located& located;        ///< the sites that are searched
  const Scales& scales;
  /// True if tables and short laws are tried where the grammar leaves more than the noise. Beside another term of unknown
  /// law they are not tried.
  bool tables = true;
  unsigned threads = 1;
  const Watch& watch;
  int round = 1;  ///< of the trials
};

/// Screens every term of unknown law at the sites of the task and fits the best jointly with everything else.
UnlistedSearch search_unlisted(const UnlistedTask& task);

}  // namespace hotfire::explain
