// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/record/record.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

/// What a run of a model of several axes has beside its commands.
struct VehicleRun {
  unsigned seed = 1;  ///< of the sensors' noise and of the strings' placement errors
  /// Angular momentum that each axis's engine is given after each row [N m s]; empty: none.
  std::vector<std::vector<double>> impulses = {};
};

/// Runs a model of several axes open loop on the channels `command.pitch`, `command.yaw` (several engines: `command.pitch1`
/// ...) of `inputs`, held between rows; an axis without a channel is commanded zero. What else works on the engines may be
/// in the record too, interpolated between rows:
/// - `torque.pitch` ... [N m] turns the engine towards positive angles;
/// - `force.x`, `.y`, `.z` (several engines: `force.x1` ...) [N] pushes it at its gimbal's centre;
/// - `vibration.pitch` ... [rad/s] adds to the slip of the bearing;
/// and `thrust` (several engines: `thrust.engine1` ...) [N], held between rows, in place of the declared one.
/// Starts in the steady state under the first row. Returns
/// time, every axis's command, its piston as its potentiometer reads it, its engine's true angle and load pressure, and, of
/// a model with strings, `string1` .. `string4` (several engines: `string1.engine1` ...): the change of each length from
/// zero angles. Throws FileError for a record without any command or with that of an axis the model has not, and for a model
/// that runs away.
Record simulate(const VehicleFile& model, const Record& inputs, const VehicleRun& run = {});

/// The moment arm of an axis, the one of its attach points at zero angles [m]. Throws UsageError for an axis it has not.
double moment_arm_of(const VehicleFile& model, const std::string& axis);

/// The index of an axis among those of the model. Throws UsageError for an axis it has not.
std::size_t axis_index(const VehicleFile& model, const std::string& axis);

}  // namespace hotfire
