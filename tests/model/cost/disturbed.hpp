// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/model/support/plants.hpp"

namespace hotfire::test {

/// Moves one axis from its rest to anywhere that it can be, `size` times.
template <class State>
void disturb(State& state, Random& random, double size) {
  using Axis = model::Simplex<double>;
  state.y(Axis::kOpening) += size * random.either_sign(1e-4, 1.0);
  state.y(Axis::kOpeningRate) = size * random.either_sign(1e-3, 100.0);
  state.y(Axis::kPressure) += size * random.either_sign(1e3, 2e7);
  state.y(Axis::kWashout) += size * random.either_sign(1e3, 2e7);
  state.y(Axis::kPiston) += size * random.either_sign(1e-9, 1e-2);
  state.y(Axis::kPistonRate) = size * random.either_sign(1e-9, 1.0);
  state.y(Axis::kAngle) += size * random.either_sign(1e-9, 1e-2);
  state.y(Axis::kAngleRate) = size * random.either_sign(1e-7, 2.0);
}

}  // namespace hotfire::test
