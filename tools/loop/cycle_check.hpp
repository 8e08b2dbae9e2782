// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "tools/loop/limit_cycle.hpp"

namespace hotfire::loop {

/// What a closed loop in time does that starts on a predicted limit cycle.
enum class Check {
  none,       ///< it was not simulated
  stays,      ///< at the end it oscillates as predicted
  leaves,     ///< at the end it does something else: the prediction is a balance that the loop does not keep
  unsettled,  ///< at the end it still changes
};

struct CheckedCycle {
  LimitCycle cycle{};
  Check check = Check::none;
  Oscillation end{};  ///< what the simulation does at the end
};

/// Cycles for which a check simulates. Their last third is judged. From balances that a loop with friction did not keep, the
/// amplitude had moved half of the way to the limit cycle within 12 cycles, and all of it within 24.
inline constexpr double kCheckedCycles = 36.0;

/// By how much amplitude and frequency may be off the prediction for a loop that stays [1]. Predictions were within 2 % of
/// the limit cycles in time, and balances that were left were at least 5.5 % from them.
inline constexpr double kStays = 0.05;

/// Simulates the closed loop from a cycle, and judges its end.
using CycleFlight = std::function<Oscillation(const LimitCycle&)>;

/// Simulates every stable cycle among the predicted ones. The loop stays on it if what is left at the end is nearer to it
/// than to any other, and within `kStays`. Without a flight nothing is checked.
std::vector<CheckedCycle> checked(const std::vector<LimitCycle>& predicted, const CycleFlight& flight);

}  // namespace hotfire::loop
