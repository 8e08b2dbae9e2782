// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/record/record.hpp"
#include "tools/simulate/gradients.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::python {

/// `hotfire::gradients` of a model of several axes: by the parameters of its axes, "pitch.engine.inertia", which must act.
/// A piston and a string are read without noise and steps. A parameter takes one run with dual numbers, on one of `threads`
/// threads. Throws what `simulate` throws.
std::vector<ChannelSlopes> vehicle_gradients(const VehicleFile& model, const Record& inputs,
                                             const std::vector<std::string>& keys, unsigned threads);

}  // namespace hotfire::python
