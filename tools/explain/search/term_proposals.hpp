// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/latent/form_search.hpp"
#include "tools/explain/latent/locate.hpp"
#include "tools/explain/refine/screening.hpp"

namespace hotfire::explain {

/// Terms of the grammar that explain most of what a model leaves, at the places that `located` allows, with their
/// coefficients by regression. The best first.
std::vector<ScoredForm> propose_terms(const Dataset& data, const Fitted& around, const Located& located, unsigned threads,
                                      const Watch& watch);

/// Where a fit of a proposed term starts: the model with a share of the term, and of the move of what was free before. None
/// if the model has no such term, or has a term at that site already: no site gets a second one.
std::optional<Screened> start_of(const Fitted& around, const ScoredForm& proposed, const Scales& scales, double share = 1.0);

/// The start with the share of a proposed term that leaves least when it is simulated, which is its criterion. None if no
/// share leaves less than `without`. The regression takes the motion as given, and the term changes it: at its full size it
/// may make the axis run away, where a share of it leads the fit to the law.
std::optional<Screened> best_start(const Evaluator& evaluator, const Fitted& around, const ScoredForm& proposed,
                                   const Scales& scales, double without, unsigned threads);

/// A fitted term by its argument alone, where its law has that beside a memory: the same model without the memory, to be
/// fitted. None for another law.
std::optional<Screened> without_memory(const Fitted& fitted, const Candidate& term, const Scales& scales);

}  // namespace hotfire::explain
