// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/result/result.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// The free parameters of the explained model, in its order, with the interval of the profile where there is one.
std::vector<Estimate> estimates_of(const SearchResult& found);

/// The effects that a search kept, with the estimates of their parameters.
std::vector<FoundEffect> found_effects(const Dataset& data, const SearchResult& found,
                                       const std::vector<Estimate>& estimated);

}  // namespace hotfire::explain
