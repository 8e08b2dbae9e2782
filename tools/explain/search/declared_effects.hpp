// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/refine/refiner.hpp"

namespace hotfire::explain {

/// The effects of the declared model that the records do not support: without one, and everything else fitted again, the
/// explained model is as good. An effect that another declared one needs is not taken out alone.
std::vector<Candidate> effects_without_support(const Dataset& data, const Refiner& refiner, const ModelParameters& declared,
                                               const Assessed& explained, const Watch& watch);

}  // namespace hotfire::explain
