// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <utility>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/loop/cycle_check.hpp"

namespace hotfire::loop {

/// The open loop of one amplitude, point by point.
struct LoopCurve {
  double amplitude = 0.0;  ///< of the command [rad]; 0: small deviations
  std::vector<std::pair<double, Complex>> points{};
  std::vector<double> without{};  ///< frequencies at which no balance was found [Hz]
};

/// A closed loop that was simulated.
struct Flown {
  double attitude = 0.0;  ///< at the start [rad]
  Oscillation oscillation{};
};

/// What `hotfire loop` finds.
struct LoopResult {
  std::string controller;
  std::string axis;
  std::optional<bool> stable{};  ///< in small deviations; nothing for a measured controller
  std::vector<LoopCurve> curves{};
  std::vector<MarginsAt> margins{};  ///< in the order of the curves
  std::vector<CheckedCycle> predicted{};
  std::vector<Flown> flown{};
};

std::string text_of(const LoopResult& result);
nlohmann::ordered_json to_json(const LoopResult& result);

/// Gain and phase of the open loop over the frequency.
analysis::Chart bode_chart(const LoopResult& result);

}  // namespace hotfire::loop
