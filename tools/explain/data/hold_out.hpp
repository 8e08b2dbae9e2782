// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/data/dataset.hpp"

namespace hotfire::explain {

/// Holds out every fourth block of about four seconds of each experiment (at least eight blocks a record), shifted from
/// record to record so that each kind of motion is in both parts; never the first block, which holds the start.
///
/// A fit that has not seen the largest excursion cannot be judged on it: a block that alone reaches an extreme of the input,
/// of a measured channel or of one's rate is given to the fit, and the next block that does not is held out in its place.
void hold_out(std::vector<Experiment>& experiments);

}  // namespace hotfire::explain
