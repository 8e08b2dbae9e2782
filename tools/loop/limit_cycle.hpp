// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/loop/margins.hpp"

namespace hotfire::loop {

/// An oscillation that a loop keeps up by itself.
struct LimitCycle {
  double frequency = 0.0;  ///< [Hz]
  double amplitude = 0.0;  ///< of the command's fundamental [rad]
  bool stable = false;     ///< the loop comes back to it; otherwise it parts what decays from what grows
};

/// The open loop at a frequency [Hz] and an amplitude [rad] of the command; nothing where it is not known.
using DescribedLoop = std::function<std::optional<Complex>(double frequency, double amplitude)>;

/// The margins of one amplitude.
struct MarginsAt {
  double amplitude = 0.0;  ///< [rad]; 0: small deviations
  Margins margins{};
};

/// The limit cycles that describing functions predict: open loop = -1 [Gelb and Vander Velde 1968, ch. 3]. They are looked
/// for from the margins `at` of every amplitude, in ascending order: from those near 0, and between two amplitudes of which
/// a gain margin passes it. Newton's method refines them.
/// Stable if a disturbance s = sigma + i omega that a change of amplitude causes decays for a larger amplitude:
/// Im(dL/da / (dL/domega)) < 0 (Loeb's criterion).
std::vector<LimitCycle> predicted_limit_cycles(const DescribedLoop& loop, const std::vector<MarginsAt>& at);

/// What becomes of a closed loop in time.
enum class Outcome { decays, oscillates, grows, unsettled };

struct Oscillation {
  Outcome outcome = Outcome::unsettled;
  double frequency = 0.0;  ///< [Hz], of what is left at the end; 0 if there is no oscillation
  double amplitude = 0.0;  ///< of its fundamental
};

/// Judges the samples of a signal, `period` [s] apart, of a loop that was left alone: over its last third against the third
/// before it. What is below `floor` has decayed.
Oscillation oscillation_of(const std::vector<double>& samples, double period, double floor);

}  // namespace hotfire::loop
