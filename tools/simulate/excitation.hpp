// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/numerics/interpolation.hpp"

namespace hotfire {

/// What drives a plant between the rows of a record.
///
/// A command is held between rows: that is what a controller does. A measured force is a sampled continuous signal, which is
/// interpolated (`model::Interpolation`): each plant step gets the mean over its own part of the row.
class Excitation {
 public:
  enum class Between { held, interpolated };

  Excitation(std::span<const double> values, int steps, Between between)
      : values_(values),
        between_(between),
        interpolation_(between == Between::interpolated ? values : std::span<const double>()) {
    for (int step = 0; between == Between::interpolated && step < steps; ++step) {
      weights_.push_back(
          interpolation_.mean_weights(static_cast<double>(step) / steps, static_cast<double>(step + 1) / steps));
    }
  }

  std::size_t rows() const { return values_.size(); }

  /// Mean of the input over plant step `step` of a row.
  double operator()(std::size_t row, int step) const {
    return between_ == Between::held ? values_[row]
                                     : interpolation_.mean(values_, row, weights_[static_cast<std::size_t>(step)]);
  }

 private:
  std::span<const double> values_;
  Between between_;
  model::Interpolation interpolation_;
  std::vector<model::Interpolation::Weights> weights_;
};

/// How the input of a plant goes on between rows: a `direct` mass is driven by a measured force, a hydraulic axis by a
/// command.
template <class Plant>
constexpr Excitation::Between between_rows() {
  return Plant::topology == "direct" ? Excitation::Between::interpolated : Excitation::Between::held;
}

}  // namespace hotfire
