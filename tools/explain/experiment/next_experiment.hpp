// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/explain/experiment/test_profiles.hpp"
#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::explain {

/// Another candidate that explains the records as well as the one that was kept.
struct Rival {
  Candidate kept;
  Candidate other;
  Fitted model;  ///< with `other` in the place of `kept`
};

/// The test that separates two models of the same rig.
struct NextExperiment {
  std::string words;        ///< TestProfile::words
  double separation = 0.0;  ///< rms of the difference of what they predict over the sensor noise, largest channel
  Record command;           ///< time and command: what `hotfire simulate` runs
  std::string parts;        ///< TestProfile::parts: what `hotfire lab` runs
};

/// The largest command of the records, either way.
CommandLimits limits_of(const Dataset& data);

/// Simulates both models over the profiles of test_profiles.hpp within the limits and below a tenth of the records' sampling
/// rate; returns the one under which they differ most. Of two that differ alike the shorter one wins. Without words where
/// the limits leave no profile.
NextExperiment best_separation(const Dataset& data, const Fitted& one, const Fitted& other, const CommandLimits& limits,
                               unsigned threads);

}  // namespace hotfire::explain
