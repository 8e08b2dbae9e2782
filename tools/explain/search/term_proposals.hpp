// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/latent/locate.hpp"
#include "tools/explain/search/screening.hpp"

namespace hotfire::explain {

/// Terms of the grammar that explain most of what a model leaves, at the places that `located` allows: where a fit of each
/// starts, with its coefficients by regression. The best first. A site that has a term already gets no second one.
std::vector<Screened> propose_terms(const Dataset& data, const Fitted& around, const Located& located, const Scales& scales,
                                    unsigned threads, const Watch& watch);

}  // namespace hotfire::explain
