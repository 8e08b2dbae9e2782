// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/loop/controller.hpp"

namespace hotfire::loop {

/// Where the open loop has the size 1: phase margin.
struct PhaseMargin {
  double frequency = 0.0;  ///< [Hz]
  double degrees = 0.0;    ///< angle from -1, -180 to 180
};

/// Where the open loop is real and negative: gain margin.
struct GainMargin {
  double frequency = 0.0;  ///< [Hz]
  double decibels = 0.0;   ///< above 0: by which the gain may rise; below 0: by which it may fall
};

struct Margins {
  std::vector<PhaseMargin> phase{};
  std::vector<GainMargin> gain{};
};

/// The open loop at a frequency [Hz]; nothing where it is not known.
using OpenLoop = std::function<std::optional<Complex>(double)>;

/// The margins between the frequencies of a grid, each refined to `accuracy`, relative in frequency. With the default the
/// margins of a smooth loop are exact to 1e-9 dB and 1e-9 deg.
Margins margins_of(const OpenLoop& loop, const std::vector<double>& frequencies, double accuracy = 1e-12);

}  // namespace hotfire::loop
