// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hotfire::analysis {

/// How one channel answered one step of a command. Lengths of time are from the step, in seconds; NaN for what did not
/// happen before the next step.
struct StepResponse {
  std::size_t row = 0;         ///< first row of the new command
  double from = 0.0;           ///< command before
  double to = 0.0;             ///< command after
  double change = 0.0;         ///< of the channel, from before the step to where it settled
  double rise_time = 0.0;      ///< from 10 to 90 % of the change
  double overshoot = 0.0;      ///< beyond the change, over the change
  double settling_time = 0.0;  ///< until it stays within 5 % of the change
  /// Longest time, before 90 % of the change is reached, in which the channel got no further by 1 % of the change: waiting
  /// at the start and stalls on the way alike.
  double hesitation = 0.0;
};

/// Finds the steps of a command (held between them) and measures a channel's answer to each. A step is a change within one
/// row of more than a hundredth of the command's range that is followed by a constant command for at least `hold` [s].
std::vector<StepResponse> step_responses(std::span<const double> command, std::span<const double> channel, double period,
                                         double hold);

}  // namespace hotfire::analysis
