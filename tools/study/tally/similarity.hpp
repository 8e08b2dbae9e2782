// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/study/tally/judge.hpp"

namespace hotfire::study {

/// What the finder made of a case as it is, and of the same case on a rig a hundred times smaller and ten times faster.
struct SimilarPair {
  Judgement as_made;
  Judgement small_and_fast;

  /// The same effects at the same sites with the same laws.
  bool same_names() const;
  /// The error over the noise is equal within 10 % in every channel, or below a twentieth of the noise on both: there what
  /// is left is where the fit stops, and the step of the simulation.
  bool same_errors() const;
};

/// Explains the case in a folder twice. Throws FileError if the folder is no case of one axis.
SimilarPair judge_similar(const std::filesystem::path& folder, unsigned threads);

std::string line_of(const SimilarPair& pair);
nlohmann::json json_of(const SimilarPair& pair);

/// Names equal in all, errors equal in all.
std::string summary_of(const std::vector<SimilarPair>& pairs);
bool all_met(const std::vector<SimilarPair>& pairs);

}  // namespace hotfire::study
