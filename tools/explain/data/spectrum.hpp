// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tools/explain/data/dataset.hpp"

namespace hotfire::explain {

/// The least length from `least` on without a prime factor above 5: the fast Fourier transform is fast there.
std::size_t fast_transform_length(std::size_t least);

/// The strongest frequencies [Hz] of the residuals of one channel (measured minus predicted), strongest first, at most
/// `count`, at least a quarter octave apart: where a missing mode may lie. Periodograms of Hann-windowed stretches, averaged
/// (Welch 1967).
std::vector<double> strongest_frequencies(const Dataset& data,
                                          const std::vector<std::vector<std::vector<double>>>& prediction,
                                          std::size_t channel, std::size_t count);

/// Each of the frequencies, moved within a bin of that spectrum to where a sinusoid explains most of what is left of the
/// channel on the rows that a fit sees, its phase free in every record (periodogram over whole records, Schuster 1898): a
/// fit from a frequency that gains or loses half a cycle over a record would not find it.
std::vector<double> sharpened_frequencies(const Dataset& data,
                                          const std::vector<std::vector<std::vector<double>>>& prediction,
                                          std::size_t channel, std::vector<double> frequencies);

}  // namespace hotfire::explain
