// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// What becomes of a candidate whose round was interrupted.
inline constexpr const char* kUndecided = "undecided";

/// One candidate in one round, and what became of it.
struct Trial {
  int round = 0;
  Candidate candidate;
  bool refined = false;          ///< fitted jointly with everything else
  double delta_criterion = 0.0;  ///< BIC with it minus without it (negative is better)
  double held_out_ratio = 1.0;   ///< held-out error with it over without it; 1 if not refined
  double seconds = 0.0;
  std::string decision;  ///< "kept", "dropped", "tied" with the one kept, "taken out", kUndecided
  std::string reason;
  bool screened = true;  ///< false: never fitted, a law that was to start from where one that it contains ends
};

/// An effect the search kept, with what it reached when it was added and the other effects tried in its place, best first.
struct Kept {
  Trial trial;
  std::vector<Trial> alternatives;
};

/// The site of what was kept, and those of terms at other sites that the records do not separate from it.
std::vector<std::string> sites_of(const Kept& kept);

/// "gimbal_friction (lugre)".
std::string label(const Candidate& candidate);

/// True if what was tried lowers the BIC and the held-out error clearly.
bool is_supported(const Trial& trial);

/// True if what was tried, a model without an effect, raises neither clearly. The BIC alone would not do: each of two models
/// that leave another channel far off is the better one on its own effective samples.
bool is_as_good(const Trial& trial);

/// Why a candidate was kept or dropped, in words. `best` is the one with the lowest BIC of its round, if any was fitted
/// jointly.
std::string reason_of(const Trial& trial, const Trial* best);

}  // namespace hotfire::explain
