// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tools/analysis/frequency_response.hpp"

namespace hotfire::analysis {

/// A one-sided power spectral density: `density[k]` at k / (rows * period), in the signal's unit squared per hertz.
struct Spectrum {
  double resolution = 0.0;  ///< [Hz]
  std::vector<double> density;
};

/// How a record is cut into parts that overlap by half, each without its mean and under a Hann window.
struct Segments {
  std::size_t rows = 0;  ///< of one part; at least 8 and no more than the record has
};

/// Power spectral density by averaging over segments [Welch 1967, IEEE Trans. Audio Electroacoustics 15(2)].
Spectrum welch_spectrum(std::span<const double> signal, double period, Segments segments);

/// Frequency response of output to input, H1 = S_xy / S_xx, with coherence |S_xy|^2 / (S_xx S_yy) [Bendat and Piersol,
/// Random Data, ch. 6], between `lowest` and `highest` [Hz]. Frequencies at which the input has less than 1e-8 of its
/// largest density are left out: nothing was asked there. One segment alone has a coherence of 1 and says nothing by it.
FrequencyResponse welch_response(std::span<const double> input, std::span<const double> output, double period,
                                 Segments segments, double lowest, double highest);

/// Frequency response of output to input over exactly one repeat of an input that repeats, both in their steady state: the
/// ratio of their transforms, without a window, so that no line leaks into another. Between `lowest` and `highest` [Hz], at
/// the lines in which the input has at least 1e-4 of its largest amplitude.
FrequencyResponse periodic_response(std::span<const double> input, std::span<const double> output, double period,
                                    double lowest, double highest);

}  // namespace hotfire::analysis
