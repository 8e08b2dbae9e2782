// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tools/analysis/frequency_response.hpp"

namespace hotfire::analysis {

/// Rows over which a command is a sine of one frequency and amplitude about zero.
struct Dwell {
  std::size_t first = 0;
  std::size_t rows = 0;
  double frequency = 0.0;  ///< [Hz]
  double amplitude = 0.0;  ///< in the command's unit
};

/// The dwells of a stepped-sine command, found in the command itself, so that a recorded test needs no further file: at
/// least three successive periods whose length agrees within 1 % and whose amplitude within 2 %. Where they add up to more
/// than one frequency, each is a dwell of its own: steps of 0.25 % are separated from eight periods on. Each dwell must
/// begin and end near zero phase. Empty for a command that is not a stepped sine.
std::vector<Dwell> find_dwells(std::span<const double> command, double period);

/// The fundamental of a signal over rows: constant + drift t + Re(amplitude e^{i 2 pi f t}), fitted by least squares, t from
/// row 0 of the record. `explained` is the share of its power, without constant and drift, that the sine has.
struct Fundamental {
  std::complex<double> amplitude;
  double explained = 0.0;
};

Fundamental fit_sine(std::span<const double> signal, std::size_t first, std::size_t rows, double frequency, double period);

/// The response to the sines of one amplitude.
struct AmplitudeResponse {
  double amplitude = 0.0;
  FrequencyResponse response;
};

/// Sine-by-sine response of output to command, one of each amplitude, in order of amplitude. The second half of each dwell's
/// periods is used, at least one: the first half is for settling. Coherence is the share of the output's power in its
/// fundamental: what friction and play put into harmonics is missing from it.
std::vector<AmplitudeResponse> sine_responses(std::span<const double> command, std::span<const double> output, double period,
                                              const std::vector<Dwell>& dwells);

}  // namespace hotfire::analysis
