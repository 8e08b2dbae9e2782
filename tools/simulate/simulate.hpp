// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// Runs a model open loop on the input channel of `inputs` (a command, held between rows, or a measured force, interpolated
/// between them: excitation.hpp). A hydraulic axis may have a `torque` channel beside it [N m], a measured torque on its
/// engine towards positive angles. Starts at rest: a hydraulic axis in the steady state under the first command, a `direct`
/// mass at the first row of its `position` channel (or at zero without one). If `fit_start_rows` > 0, the initial state of a
/// `direct` mass is fitted on that many rows instead. Returns time, input and every model channel on the inputs' grid.
Record simulate(const ModelFile& model, const Record& inputs, std::size_t fit_start_rows = 0);

/// The moment arm of a hydraulic axis [m]; 1 for a `direct` mass, whose channels are in one unit.
double moment_arm_of(const ModelFile& model);

}  // namespace hotfire
