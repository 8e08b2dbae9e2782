// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "tools/study/draws/random.hpp"

namespace hotfire::study {

/// One degree [rad].
inline constexpr double kDegree = std::numbers::pi / 180.0;

inline constexpr double kSample = 2e-3;  ///< of every record [s]

/// A record's name and its commands [rad], one a sample.
struct Profile {
  std::string name;
  std::vector<double> commands;
};

/// What a rig is driven through: sweeps (0.4 deg from 0.4 to 6 Hz, 0.8 deg from 7 to 14 Hz; 52 s), steps of 0.6, 0.4 and 0.2
/// deg (25 s), and ramps (0.5 and 6 deg triangles, a 2 deg sine, a 0.1 deg sweep; 54 s). Amplitudes and frequencies vary by
/// a tenth.
std::vector<Profile> given_profiles(Random random);

/// What the finder never sees: a random multisine up to 8 Hz of about 0.8 deg, uneven steps, a 0.25 deg sweep and a faster 6
/// deg triangle (59 s).
Profile unseen_profile(Random random);

}  // namespace hotfire::study
