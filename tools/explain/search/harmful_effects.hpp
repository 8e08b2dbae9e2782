// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// Takes out what leaves more of a record or of a band than the calibrated model does. It judges all that was found
/// together: of two effects that act on one record, each alone may leave more of it. Of the effects without which nothing
/// is worse, the one is taken out that leaves the least error; without such an effect it is the last.
/// Returns whether any was taken out.
bool take_out_harmful(const Dataset& data, const Refiner& refiner, const Watch& watch, SearchResult& result);

}  // namespace hotfire::explain
