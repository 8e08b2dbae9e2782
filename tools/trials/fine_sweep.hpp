// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

/// How long a free motion of the model may take to die out to a thousandth [s]: that of the engine on its damping alone, or
/// of the least damped of a vehicle's modes within `lowest` and `highest` [Hz], whichever is longer. The servo damps the
/// engine further, so this is an upper bound for it. A `direct` mass by its own damping.
double settling_time(const ModelFile& model);
double settling_time(const VehicleFile& model, double lowest, double highest);

/// The longest that a frequency is held for, whatever the damping [s].
inline constexpr double kLongestDwell = 40.0;

/// How long a sine is held: twice the settling time, as the analysis uses the second half, at least
/// `kShortestDwell` and no more than `kLongestDwell` [s].
double settled_dwell(double settling);

/// The sines of `bands`, and around every notch that a first sweep of them has found in the piston, 25 frequencies 0.25 %
/// apart to either side: fine enough for its vertex to lie within 0.1 % beside light damping. Each is held for
/// `settled_dwell(settling)`.
std::vector<double> fine_sines(const std::vector<SineBand>& bands, const std::vector<ChannelSweep>& coarse, double settling);

}  // namespace hotfire::trials
