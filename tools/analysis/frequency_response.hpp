// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace hotfire::analysis {

/// One point of a frequency response. `coherence` is the share of the output's power that is linear in the input, 0 to 1.
struct ResponsePoint {
  double frequency = 0.0;  ///< [Hz]
  std::complex<double> gain;
  double coherence = 0.0;
};

/// Ascending in frequency.
using FrequencyResponse = std::vector<ResponsePoint>;

inline double decibels(double ratio) { return 20.0 * std::log10(std::max(ratio, 1e-12)); }

inline double gain_decibels(const ResponsePoint& point) { return decibels(std::abs(point.gain)); }

/// Phase of every point [deg], continued over +-180.
inline std::vector<double> phase_degrees(const FrequencyResponse& response) {
  std::vector<double> phase;
  for (const ResponsePoint& point : response) {
    double own = std::arg(point.gain) * 180.0 / std::numbers::pi;
    if (!phase.empty()) {
      own += 360.0 * std::round((phase.back() - own) / 360.0);
    }
    phase.push_back(own);
  }
  return phase;
}

}  // namespace hotfire::analysis
