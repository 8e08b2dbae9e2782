// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hotfire::response {

/// The load resonance that a test has shown of one axis of a condition: the notch of its piston, or the oscillation of the
/// engine with the actuator locked. Both have the total stiffness in them [SD eq. 2-3, 10].
struct MeasuredAxis {
  std::string condition;
  std::string axis;
  double resonance;  ///< [Hz]
};

/// Reads `condition,axis,resonance[Hz]`, a row an axis. Lines that begin with # are
/// comments. Throws FileError naming file, line, column, value and what is allowed.
std::vector<MeasuredAxis> load_measured(const std::filesystem::path& path);

}  // namespace hotfire::response
