// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// A quantity that a missing term may depend on, or the term itself, by row.
struct Quantity {
  std::string label;  ///< "engine rate"
  std::string unit;
  std::vector<double> values;
};

/// The term that is missing in the equations, computed from the measured channels alone: what the model's equation at one
/// place leaves over when measured motion is put in.
struct Trace {
  std::string equation;  ///< "engine", "flow", "mass"
  Quantity missing;
  double signal_to_noise = 0.0;  ///< rms over the rms that sensor noise alone would give
  Quantity depends_on;           ///< of the quantities examined, the one that explains most of it
  double share = 0.0;            ///< share of the missing term's variance that it explains (correlation ratio)
};

/// Reconstructs the missing term of every equation whose quantities are measured, loudest against noise first. Motion is
/// smoothed by a zero-phase Gaussian (about 12 Hz, or a fortieth of the sampling rate) before it is differentiated; what
/// noise alone would leave is found by passing noise of the channels' rms through the same reconstruction.
std::vector<Trace> reconstruct(const Dataset& data, const ModelParameters& parameters);

/// The strongest trace in one sentence.
std::string in_words(const Trace& trace);

}  // namespace hotfire::explain
