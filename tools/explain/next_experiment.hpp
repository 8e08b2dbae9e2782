#pragma once

#include <string>

#include "tools/explain/candidates.hpp"
#include "tools/explain/fit.hpp"
#include "tools/files/record.hpp"

namespace hotfire::explain {

/// Another candidate that explains the records as well as the one that was kept.
template <class Family>
struct Rival {
  Candidate kept;
  Candidate other;
  Fitted<Family> model;  ///< with `other` in the place of `kept`
};

/// The test that tells two models of the same rig apart.
struct NextExperiment {
  std::string words;        ///< "a sine of 0.4 deg at 2 Hz about 0.8 deg, for 8 s"
  double separation = 0.0;  ///< rms of the difference of what they predict over the sensor noise, largest channel
  Record command;           ///< time and command: what `hotfire simulate` and a rig run
};

/// Simulates both models over sines, sweeps, steps and ramps within the largest command of the records (amplitude and bias
/// together) and below a tenth of their sampling rate; returns the profile under which they differ most. Of two that differ
/// alike the shorter one wins.
NextExperiment best_separation(const Dataset& data, const Fitted<SimplexFamily>& one, const Fitted<SimplexFamily>& other,
                               unsigned threads);

}  // namespace hotfire::explain
