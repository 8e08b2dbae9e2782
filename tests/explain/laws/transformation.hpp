// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "tests/explain/laws/given.hpp"

namespace hotfire::test {

/// How closely the answer agrees with the original after a transformation.
enum class Agreement {
  same_bits,  ///< every bit of it
  same,       ///< all of it, to rounding: two fits of it differ by what a fit leaves when it stops
  other       ///< other noise, or fewer rows: two fits of it differ by their standard errors
};

/// A change of what the finder is given under which its answer has to follow.
struct Transformation {
  const char* name;
  Given (*apply)(Given);
  Agreement agreement;
  /// What a parameter of a unit is multiplied by; null: one.
  double (*factor)(const std::string& key, const std::string& unit);
};

extern const Transformation kOtherUnits;
extern const Transformation kMirror;
extern const Transformation kOtherOrder;
extern const Transformation kCutInTwo;
extern const Transformation kLater;
extern const Transformation kSinceEpoch;
extern const Transformation kUnusedChannel;
extern const Transformation kDeafChannel;
extern const Transformation kHalfTheRate;
extern const Transformation kTwiceTheNoise;
extern const Transformation kSmallAndFastRig;
extern const Transformation kOneThread;

}  // namespace hotfire::test
