// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace hotfire::analysis {

/// A ringing that dies out.
struct FreeDecay {
  double frequency = 0.0;      ///< [Hz]
  double damping_ratio = 0.0;  ///< from the logarithmic decrement
  int cycles = 0;              ///< that were used
};

/// Frequency and damping of a free decay from the first `seconds`: crossings of zero and the extremes between them, as long
/// as these exceed 5 % of the largest. None if there are fewer than three cycles. With a spring that is softer under small
/// loads the frequency falls as the decay goes on: say how much of it is meant.
std::optional<FreeDecay> free_decay(std::span<const double> signal, double period, double seconds);

}  // namespace hotfire::analysis
