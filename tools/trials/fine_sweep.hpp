// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/structure/vehicle_file.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

/// How long a sine is held so that its second half, which the analysis uses, is settled: twice the time in which every free
/// motion has died out to a thousandth of its part of the response, at least `kShortestDwell`.
///
/// - Engine: by its damping alone, without limit of frequency. The servo damps it further, so this is an upper bound, and no
///   more than `kLongestEngineDwell` is waited for it. A `direct` mass by its own damping.
/// - Modes of a vehicle within `lowest` and `highest` [Hz]: as the fit sees them. Over t seconds it takes no more than
///   1 / (pi t |f - f_mode|) of a motion at f_mode for one at f, beside what is left of it, e^{-2 pi f_mode zeta t}. So a
///   mode is waited for in full where it is close, and less further off. No more than `kLongestDwell` is waited for one.
LeastDwell settled_dwell(const ModelFile& model);
LeastDwell settled_dwell(const VehicleFile& model, double lowest, double highest);

/// The longest that a sine is held for the engine [s]: its free motion under the servo dies out within half of it.
inline constexpr double kLongestEngineDwell = 40.0;

/// The longest that a sine is held for a mode [s]. In half of it a mode of half a percent of critical damping dies out to a
/// thousandth from 0.37 Hz on, which is below where a sweep begins by default.
inline constexpr double kLongestDwell = 1200.0;

/// The sines of `bands`, and around every notch that a first sweep of them has found in the piston, 25 frequencies 0.25 %
/// apart to either side: fine enough for its vertex to lie within 0.1 % beside light damping. Each is held for `dwell`.
std::vector<double> fine_sines(const std::vector<SineBand>& bands, const std::vector<ChannelSweep>& coarse,
                               const LeastDwell& dwell);

}  // namespace hotfire::trials
