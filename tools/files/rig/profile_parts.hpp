// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/files/rig/profile_numbers.hpp"

namespace hotfire {

/// Angles [rad], one for each actuator.
using Angles = std::vector<double>;

/// A stretch of a profile as the real-time side knows it: a straight line with a sine on it, which begins at phase 0 and
/// whose frequency changes by the same factor in equal times.
struct Stretch {
  double duration = 0.0;
  Angles from;
  Angles to;
  Angles amplitude;
  double frequency = 1.0;
  double last_frequency = 1.0;

  double highest(std::size_t actuator) const {
    return std::max(from[actuator], to[actuator]) + std::abs(amplitude[actuator]);
  }
  double lowest(std::size_t actuator) const {
    return std::min(from[actuator], to[actuator]) - std::abs(amplitude[actuator]);
  }
  /// The greatest rate of the command that it can have [rad/s].
  double rate(std::size_t actuator) const;
  /// Where it ends.
  double end(std::size_t actuator) const;
};

/// What the profile asks for is held to this, actuator by actuator.
struct StretchLimits {
  Angles lowest;           ///< [rad]
  Angles highest;          ///< [rad]
  Angles rate;             ///< [rad/s]
  double slew_rate = 0.0;  ///< of the lines between stretches that do not meet [rad/s]
};

/// The stretches of the parts `[[profile]]` of a file, in their order. Where one does not begin where the one before has
/// ended, as at a step, a straight line at the slew rate goes between them, in the time of a level, else beside that of
/// both. Refuses what is beyond the limits.
std::vector<Stretch> read_profile_parts(const ProfileNumbers& numbers, const StretchLimits& limits);

}  // namespace hotfire
