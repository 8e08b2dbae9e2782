// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/files/record/record.hpp"

namespace hotfire::trials {

/// Sampling period of every profile [s].
inline constexpr double kPeriod = 1e-3;

/// Sines of one amplitude at some frequencies, one after the other.
struct SineBand {
  double amplitude = 0.0;           ///< [rad]
  std::vector<double> frequencies;  ///< [Hz]
};

/// `count` frequencies from `lowest` to `highest`, at equal ratios.
std::vector<double> spaced(double lowest, double highest, int count);

/// How long a sine is held for at the least, whatever the damping [s].
inline constexpr double kShortestDwell = 2.0;

/// A stepped sine: each frequency for at least eight whole periods and `least_seconds`, from zero phase to zero phase.
std::vector<double> stepped_sines(const std::vector<SineBand>& bands, double least_seconds = kShortestDwell);

/// How long a sine of a frequency [Hz] is held for at the least [s].
using LeastDwell = std::function<double(double frequency)>;

/// The same, each frequency for its own time.
std::vector<double> stepped_sines(const std::vector<SineBand>& bands, const LeastDwell& least_seconds);

/// The frequencies and amplitudes of the Green Run hot-fire test [GF slide Green Run Hot Fire]: 7 to 14 Hz at 0.8 deg and
/// 0.40 to 6.25 Hz at 0.4 deg. The paper does not say which frequencies lie between: here steps of 0.25 Hz above, and 16 at
/// equal ratios below. Pitch was driven in this order, yaw in the other.
std::vector<SineBand> green_run_sines(bool yaw = false);

/// The whole profile, both axes at once [GF slide Green Run Hot Fire, the table]: pitch at 7 to 14 Hz and 0.8 deg beside yaw
/// at 0.40 to 6.25 Hz and 0.4 deg, then the other way round. The upper band dwells longer on each frequency than the lower,
/// so that both end together. Channels `command.pitch` and `command.yaw`.
Record green_run_record();

/// A multisine that repeats every `length` seconds, `repeats` times: every multiple of 1 / length between `lowest` and
/// `highest` [Hz], equal amplitudes, random phases from `seed`, scaled to a peak of `amplitude` [rad].
std::vector<double> multisine(double amplitude, double lowest, double highest, double length, int repeats, unsigned seed);

/// Steps from zero to each amplitude and back, then to its negative and back, each held for `hold` seconds [GF slide Green
/// Run Hot Fire: 0.6, 0.4 and 0.2 deg].
std::vector<double> steps(const std::vector<double>& amplitudes, double hold);

/// A record that has one command channel.
Record command_record(std::vector<double> command, const std::string& channel = "command");

inline double radians(double degrees) { return degrees * 0.017453292519943295; }
inline double degrees(double radians) { return radians / 0.017453292519943295; }

}  // namespace hotfire::trials
