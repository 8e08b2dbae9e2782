// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "model/sensors/string_potentiometer.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

/// What reads the pistons and engines of a model of several axes. Left out: pistons read ideally, no strings.
struct VehicleSensors {
  using Readout = model::PotentiometerReadout<double>;
  using Strings = model::StringPotentiometers<double>;

  Readout piston;                         ///< of every piston
  std::vector<Strings::Anchors> strings;  ///< of every engine; empty: there are none
  Readout string;                         ///< of every string
  double placement_error = 0.0;           ///< rms in each direction: how far an anchor is from where it is drawn [m]

  /// How far each mode, and each force on a port beyond the modes, pulls the ends of a string together (mode_table.hpp).
  Eigen::MatrixXd string_shape;
  Eigen::MatrixXd string_residual;
};

/// The table within `[sensors]` that holds the pistons' readout; what else is there is noise of records, by axis.
inline constexpr std::string_view kPistonSensor = "piston";

/// Reads `[sensors.piston]` and `[strings]` with `[strings.string1]` ... and, where an engine differs from the others,
/// `[strings.string1.engine2]`. Throws FileError naming file, line, key, value and what is allowed: a value outside its
/// bounds, an unknown string or engine, a string whose ends coincide, strings that cannot distinguish pitch from yaw.
/// The other keys of `[sensors]` are not looked at: load_vehicle refuses those that nobody knows.
VehicleSensors read_vehicle_sensors(const TomlSource& source, int engines);

/// The TOML text of these tables, empty for ideal pistons without strings; read back bit for bit.
std::string vehicle_sensors_text(const VehicleSensors& sensors);

}  // namespace hotfire
