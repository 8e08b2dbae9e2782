// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "model/numerics/interpolation.hpp"
#include "model/numerics/scalar.hpp"
#include "model/numerics/step_size.hpp"

namespace hotfire {

/// Plant steps in a row of a record. A path is known between its rows too, and a force that sets in between two rows is in
/// the wrong one for as long as a step: a path has at least `kStepsOnPath`, which makes that an eighth of a row.
inline constexpr int kStepsOnPath = 8;
template <class Plant>
int steps_in_row(const typename Plant::Parameters& parameters, double period) {
  if constexpr (Plant::topology == "imposed_motion") {
    return std::max(kStepsOnPath, model::steps_per_period(period));
  } else {
    return model::steps_per_period<Plant>(parameters, period);
  }
}

/// A measured position between its rows, at the ends of plant steps: the polynomial through neighbouring rows as
/// `model::Interpolation` chooses them, through the six nearest at the ends of the record. Beyond the ends it goes on with
/// the second difference that it has there.
class Path {
 public:
  Path(std::span<const double> values, int steps) : values_(values), steps_(steps), interpolation_(values) {
    for (int step = 0; step < steps; ++step) {
      weights_.push_back(interpolation_.weights(static_cast<double>(step) / steps));
    }
  }

  /// The position at the end of `step` steps after the first row; from -1 on.
  double at(std::ptrdiff_t step) const {
    const std::ptrdiff_t last = (static_cast<std::ptrdiff_t>(values_.size()) - 1) * steps_;
    if (last < 2) {
      return values_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(step, 0, last))];
    }
    if (step < 0) {
      return 3.0 * inside(0) - 3.0 * inside(1) + inside(2);
    }
    return step <= last ? inside(step) : 3.0 * inside(last) - 3.0 * inside(last - 1) + inside(last - 2);
  }

 private:
  double inside(std::ptrdiff_t step) const {
    const auto row = static_cast<std::size_t>(step / steps_);
    const auto part = static_cast<std::size_t>(step % steps_);
    if (part == 0) {
      return values_[row];
    }
    return interpolation_.reaches(row, values_.size()) ? interpolation_.mean(values_, row, weights_[part])
                                                       : near_end(row, static_cast<double>(part) / steps_);
  }

  double near_end(std::size_t row, double part) const {
    const std::size_t nodes = std::min<std::size_t>(6, values_.size());
    const std::size_t first = std::min(row - std::min(row, nodes / 2 - 1), values_.size() - nodes);
    const int count = static_cast<int>(nodes);
    const double place = static_cast<double>(row - first) + part - static_cast<double>(model::Interpolation::before(count));
    const auto weights = model::Interpolation::weights_at(count, place);
    double sum = 0.0;
    for (std::size_t node = 0; node < nodes; ++node) {
      sum += weights[node] * values_[first + node];
    }
    return sum;
  }

  std::span<const double> values_;
  std::ptrdiff_t steps_;
  model::Interpolation interpolation_;
  std::vector<model::Interpolation::Weights> weights_;
};

/// The state of a body at the first row of a path, at a time `start` [s]: it has moved on by one step, since the force at
/// the first row needs the positions around it.
template <class Plant>
typename Plant::State enter_path(const Plant& plant, std::span<const double> values, double period, double start) {
  using S = typename Plant::Scalar;
  const Path path(values, static_cast<int>(std::lround(period / plant.step_size())));
  typename Plant::State state = plant.at_rest(S(path.at(-1)));
  state.clock.start = model::Precise<S>(start - plant.step_size());
  plant.step(state, S(path.at(0)));
  plant.step(state, S(path.at(1)));
  return state;
}

}  // namespace hotfire
