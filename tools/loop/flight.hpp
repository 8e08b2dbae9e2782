// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/interface/plant/plant.hpp"
#include "tools/loop/controller.hpp"
#include "tools/loop/stage.hpp"

namespace hotfire::loop {

/// The closed loop in time: the plant that the rig runs, the stage that it turns, and the controller at its samples.
struct FlightPlan {
  double attitude = 0.0;  ///< by which the stage is turned at the start [rad]
  double seconds = 0.0;
};

/// Of every sample of the controller.
struct FlightRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> command;   ///< [rad]
  std::vector<double> attitude;  ///< [rad]
  bool ran_away = false;         ///< it ends where the attitude exceeds a radian
};

/// Flies it from the steady state under zero commands.
/// Throws UsageError for a controller that is a measured frequency response, which is no law in time, and for a delay that
/// is no whole number of the plant's steps.
FlightRecord fly(const plant::AnyParameters& parameters, const Stage& stage, const Controller& controller,
                 const FlightPlan& plan);

}  // namespace hotfire::loop
