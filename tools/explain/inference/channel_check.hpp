// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/fit/goodness.hpp"

namespace hotfire::explain {

/// Refuses records that no axis near the declared one can have made, before anything is fitted to them: a channel that runs
/// against the model (inverted), or that follows it at less than a fifth or more than five times its size (mis-scaled). If
/// every channel of a record does so alike, the fault is reported as the command's.
/// For a servo only, whose motion follows its command whatever is missing in the model. `prediction` is that of the declared
/// model. Throws FileError with record, channel, correlation, ratio and the remedy.
void refuse_impossible_channels(const Dataset& data, const Prediction& prediction);

}  // namespace hotfire::explain
