#pragma once

#include "tools/files/record.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

/// Runs a model of several axes open loop on the channels `command.pitch`, `command.yaw` (several engines: `command.pitch1`
/// ...) of `inputs`, held between rows; an axis without a channel is commanded zero. Starts in the steady state under the
/// first row. Returns time, every axis's command, and its piston, engine and load pressure. Throws FileError for a record
/// without any command or with that of an axis the model has not, and for a model that runs away.
Record simulate(const VehicleFile& model, const Record& inputs);

/// The moment arm of an axis, the one of its attach points at zero angles [m]. Throws UsageError for an axis it has not.
double moment_arm_of(const VehicleFile& model, const std::string& axis);

}  // namespace hotfire
