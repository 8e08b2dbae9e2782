// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tools/analysis/frequency_response.hpp"
#include "tools/analysis/welch.hpp"

namespace hotfire::analysis {

/// A notch: a local minimum of the gain.
struct Notch {
  double frequency = 0.0;  ///< [Hz]
  double gain = 0.0;       ///< [dB]
  double depth = 0.0;      ///< under its upper shoulder, the largest gain above it in the band [dB]
};

/// The notch of a response between `lowest` and `highest` [Hz] that lies deepest under its upper shoulder; none if the gain
/// has no minimum inside the band. Its frequency is the vertex of |gain|^2 over frequency^2 through the least point and its
/// neighbours: near a lightly damped pair of zeros |gain|^2 is just that parabola.
std::optional<Notch> find_notch(const FrequencyResponse& response, double lowest, double highest);

/// A peak of a response or spectrum.
struct Peak {
  double frequency = 0.0;  ///< [Hz]
  double gain = 0.0;       ///< [dB]
};

/// The highest local maximum of the gain between `lowest` and `highest`; none if there is none inside. The frequency is the
/// vertex of 1 / |gain|^2 over frequency^2, which near a resonance is a parabola.
std::optional<Peak> find_peak(const FrequencyResponse& response, double lowest, double highest);

/// The highest local maximum of a spectrum; `gain` is 10 log10 of its density.
std::optional<Peak> find_peak(const Spectrum& spectrum, double lowest, double highest);

}  // namespace hotfire::analysis
