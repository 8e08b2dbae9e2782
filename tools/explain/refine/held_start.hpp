// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/fit/fit.hpp"

namespace hotfire::explain {

/// Takes more rows out of the comparison at the start of records that start in motion (`Experiment::first_scored` above 0),
/// where an effect of a hydraulic axis remembers the start for longer than the axis without it: friction that holds keeps a
/// torque, of which the next reversal takes a part. What the model remembers is the difference between two simulations, from
/// rest at commands above and below the first one by the rms of the command. At most half of a record is taken out.
/// Returns whether there is such a record.
bool forget_held_starts(const Fitted& model, unsigned threads, Dataset& data);

}  // namespace hotfire::explain
