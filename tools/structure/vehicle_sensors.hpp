#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/string_potentiometer.hpp"
#include "tools/files/toml_source.hpp"

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

/// Reads `[sensors.piston]` and `[strings]` with `[strings.string1]` ... and, where an engine differs from the others,
/// `[strings.string1.engine2]`. Throws FileError naming file, line, key, value and what is allowed: a value outside its
/// bounds, an unknown string or engine, a string whose ends coincide, strings that cannot tell pitch from yaw.
VehicleSensors read_vehicle_sensors(const TomlSource& source, int engines);

}  // namespace hotfire
