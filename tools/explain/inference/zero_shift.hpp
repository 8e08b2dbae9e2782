// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "tools/explain/data/zeros.hpp"
#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// What each reading of an axis at rest moves by, for a unit of what `by` of makes `changed` of `plain`. `step` in s.
std::array<double, 3> shift_at_rest(const SimplexParameters& plain, const SimplexParameters& changed, double by,
                                    double step);

/// How far the zeros of the records are one shift of the readings. Squares are of zeros over their prior's deviations.
struct CommonShift {
  std::optional<double> amount{};  ///< that leaves the least zeros; none where the shift moves no reading that has one
  double whole = 0.0;              ///< square of all zeros
  double left = 0.0;               ///< square of what that amount does not explain
  bool shows = false;              ///< one zero is beyond the noise of its reading
};
CommonShift common_shift(const Dataset& data, const Zeros& zeros, const std::array<double, 3>& shift);

}  // namespace hotfire::explain
