// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/analysis/angle_calibration.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::trials {

/// The poses in which both commands of an engine were held for at least `hold` seconds [SD 2.3]: the commanded angles, and
/// each string's mean over the last quarter of the time. `engine` is its number where there are several, else empty; a
/// command that the record has not is zero. Throws FileError for a record without the engine's four strings or without any
/// command of it.
std::vector<analysis::SettledAngles> settled_poses(const Record& record, const std::string& engine, double hold);

/// A record with the engine's angles as its strings have them, in `engine.pitch` and `engine.yaw`, and how far they are from
/// what the record itself has there.
struct StringAngles {
  Record record;
  bool known = false;  ///< the record has both angles
  double pitch = 0.0;  ///< rms of the difference [rad]
  double yaw = 0.0;
};

/// Throws FileError for a record without the engine's four strings.
StringAngles string_angles(const Record& record, const analysis::AngleCalibration& calibration, const std::string& engine);

}  // namespace hotfire::trials
