// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tools/explain/fit/goodness.hpp"

namespace hotfire::explain {

// Statistics of the residual (measured minus predicted) of one channel, over all records together.

/// Rows by which a residual is set off against itself and against the input.
inline constexpr std::size_t kLags = 100;

/// Correlations at lags in rows, and what 99 % of them stay within (plus or minus) where there is no relation.
struct Correlation {
  std::vector<double> lags;  ///< [s]
  std::vector<double> values;
  double bound99 = 0.0;

  /// True if chance may have put what is outside the bounds there: few lags, and none of them far. Lag 0 does not count.
  bool is_none() const;
};

/// Of the residual with itself, lags 0 to `kLags`. The bound is that of white noise, 1/sqrt(n).
Correlation residual_autocorrelation(const Dataset& data, const Prediction& prediction, std::size_t channel);

/// Of the residual with the input that many rows earlier, less its mean, lags 1 to `kLags`: a controller answers the noise
/// of a row in that row, no plant does. Two unrelated series of n rows have a variance of
/// (1 + 2 sum rho_residual rho_input) / n [Ljung 1999, System Identification, section 16.6].
Correlation input_correlation(const Dataset& data, const Prediction& prediction, std::size_t channel);

/// Rms of a residual in a band of frequency [Hz], and what white noise of the channel's size has there.
struct Band {
  double from = 0.0;
  double to = 0.0;
  double rms = 0.0;
  double noise = 0.0;
};

/// On held-out rows, in Hann-windowed periodograms of the held-out blocks [Welch 1967]: half octaves from 1 Hz up, two bands
/// below. The squares of all bands sum up to the residual's.
std::vector<Band> error_by_frequency(const Dataset& data, const Prediction& prediction, std::size_t channel);

/// Rms of a residual in stretches of a range of amplitudes, and how long they are together [s].
struct AmplitudeRange {
  double from = 0.0;
  double to = 0.0;
  double rms = 0.0;
  double seconds = 0.0;
};

/// On held-out rows: stretches of a second by half of what was measured from peak to peak, in octaves down from the largest.
/// A range that holds no stretch is left out.
std::vector<AmplitudeRange> error_by_amplitude(const Dataset& data, const Prediction& prediction, std::size_t channel);

}  // namespace hotfire::explain
