// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire::plant {

/// One number that a plant takes or gives.
struct Variable {
  std::string name;         ///< as in records and model files: "command.pitch", "engine.inertia"
  std::string unit;         ///< a UDUNITS-2 string; "1" for none; empty for a unit that follows the record's own
  std::string description;  ///< one sentence without a full stop
  double start = 0.0;
  double lower = 0.0;  ///< allowed, inclusive
  double upper = 0.0;
  /// Of a parameter: it may change while the plant runs. What reads the plant is fixed, and so is where it starts.
  bool tunable = false;
};

}  // namespace hotfire::plant
