// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/interface/plant/plant.hpp"
#include "tools/loop/controller.hpp"
#include "tools/loop/limit_cycle.hpp"
#include "tools/loop/stage.hpp"

namespace hotfire::loop {

/// The closed loop in time: the plant that the rig runs, the stage that it turns, and the controller at its samples.
struct FlightPlan {
  double attitude = 0.0;  ///< by which the stage is turned at the start [rad]; unused with a cycle
  double seconds = 0.0;
  /// The loop is closed on this cycle. Before, the plant alone runs under the cycle's command until its engines move
  /// periodically; stage and controller start in the periodic state that the fundamentals of the engine angles give them.
  std::optional<LimitCycle> on{};
};

/// Of every sample of the controller, from where the loop is closed.
struct FlightRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> command;   ///< [rad]
  std::vector<double> attitude;  ///< [rad]
  bool ran_away = false;         ///< it ends where the attitude exceeds a radian
};

/// Flies it from the steady state under zero commands, or from a cycle.
/// Throws UsageError for a controller that is a measured frequency response, which is not a law in time, and for a delay
/// that is no whole number of the plant's steps.
FlightRecord fly(const plant::AnyParameters& parameters, const Stage& stage, const Controller& controller,
                 const FlightPlan& plan);

}  // namespace hotfire::loop
