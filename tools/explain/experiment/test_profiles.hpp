// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace hotfire::explain {

/// What a rig may be asked for.
struct CommandLimits {
  double lowest = 0.0;  ///< [rad]
  double highest = 0.0;
  double rate = std::numeric_limits<double>::infinity();  ///< [rad/s]; a step asks for all of it within a millisecond
};

/// A test that a rig can run: a command over time about a bias.
struct TestProfile {
  std::string words;  ///< "a sine of 0.4 deg at 2 Hz about 0.8 deg, for 8 s"
  double seconds = 0.0;
  double bias = 0.0;                         ///< [rad]
  std::function<double(double)> about_bias;  ///< [rad] at a time [s] since its beginning
  std::string parts;                         ///< the same as `[[profile]]` parts of a lab's profile file, docs/lab.md

  /// Before it begins, at rest at its bias, so that its first cycle counts [s]. `parts` has it as well.
  static constexpr double kLeadIn = 1.0;

  /// The command at every row of `period` [s], lead-in and all.
  std::vector<double> commands(double period) const;
};

/// Sines, sweeps, steps and ramps over amplitude, frequency, bias and duration, within the limits and below
/// `highest_frequency` [Hz].
std::vector<TestProfile> test_profiles(const CommandLimits& limits, double highest_frequency);

}  // namespace hotfire::explain
