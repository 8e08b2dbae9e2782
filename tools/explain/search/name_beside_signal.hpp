// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/refine/screening.hpp"

namespace hotfire::explain {

/// The name without which an unknown signal costs most (`cost_of_signal`), by its best law, fitted alone; none where the
/// signal still costs more than `share` of what it costs beside `around`. `laws`: screened beside `around`, best first.
///
/// A signal beside the calibrated model represents everything that is missing, and its prior makes that unlikely. Beside a
/// right name it has less to represent. A wrong name imitates what the signal represents anyway.
std::optional<Screened> name_that_saves_most(const Dataset& rows, const Fitted& around, const std::vector<Screened>& laws,
                                             double share, unsigned threads, const Watch& watch);

}  // namespace hotfire::explain
