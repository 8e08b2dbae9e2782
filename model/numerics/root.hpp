// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The root of a function that does not increase, searched from `start`: bracketed by widening from `width`, then found by
/// the Illinois method [Dowell and Jarratt 1971], then corrected once in the model's scalar, which carries the derivative.
/// If the function keeps its sign the last point tried is returned. Set-up only: the number of calls depends on the data.
template <class S, class F>
S root_of_decreasing(const S& start, double width, F&& function) {
  double near = 0.0;
  double at_near = value_of(function(start));
  if (at_near == 0.0) {
    return start;
  }
  double far = at_near > 0.0 ? width : -width;
  double at_far = value_of(function(start + far));
  for (int i = 0; i < 16 && at_near * at_far > 0.0; ++i) {
    near = far;
    at_near = at_far;
    far *= 4.0;
    at_far = value_of(function(start + far));
  }
  for (int i = 0; i < 60 && at_far != 0.0 && at_near * at_far < 0.0 && std::abs(far - near) > 1e-9 * width; ++i) {
    const double middle = far - at_far * (far - near) / (at_far - at_near);
    const double at_middle = value_of(function(start + middle));
    if (at_middle * at_far < 0.0) {
      near = far;
      at_near = at_far;
    } else {
      at_near *= 0.5;
    }
    far = middle;
    at_far = at_middle;
  }
  const S found = start + far;
  const double slope = value_of(function(found + width) - function(found - width)) / (2.0 * width);
  return slope < 0.0 ? found - function(found) / slope : found;
}

}  // namespace hotfire::model
