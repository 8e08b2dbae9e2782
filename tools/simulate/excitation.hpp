// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/numerics/interpolation.hpp"
#include "tools/simulate/path.hpp"

namespace hotfire {

/// What drives a plant between the rows of a record.
///
/// A command is held between rows: that is what a controller does. A measured force is a sampled continuous signal, which is
/// interpolated (`model::Interpolation`): each plant step gets the mean over its own part of the row. A path
/// (`Path`) is two steps ahead: the reading at a row needs the position one step later (`enter_path`), and the step after it
/// leads one step further.
class Excitation {
 public:
  enum class Between { held, interpolated, ahead };

  Excitation(std::span<const double> values, int steps, Between between)
      : values_(values),
        between_(between),
        steps_(steps),
        interpolation_(between == Between::interpolated ? values : std::span<const double>()) {
    if (between == Between::ahead) {
      path_.emplace(values, steps);
    }
    for (int step = 0; between == Between::interpolated && step < steps; ++step) {
      weights_.push_back(
          interpolation_.mean_weights(static_cast<double>(step) / steps, static_cast<double>(step + 1) / steps));
    }
  }

  std::size_t rows() const { return values_.size(); }

  /// Mean of the input over plant step `step` of a row; of a path, where that step leads.
  double operator()(std::size_t row, int step) const {
    return between_ == Between::held    ? values_[row]
           : between_ == Between::ahead ? path_->at(static_cast<std::ptrdiff_t>(row) * steps_ + step + 2)
                                        : interpolation_.mean(values_, row, weights_[static_cast<std::size_t>(step)]);
  }

 private:
  std::span<const double> values_;
  Between between_;
  int steps_;
  std::optional<Path> path_{};
  model::Interpolation interpolation_;
  std::vector<model::Interpolation::Weights> weights_;
};

/// How the input of a plant goes on between rows: a `direct` mass and a `modal` structure are driven by a measured force, a
/// body of `imposed_motion` is moved along a measured path, a hydraulic axis is driven by a command.
template <class Plant>
constexpr Excitation::Between between_rows() {
  return Plant::topology == "direct" || Plant::topology == "modal" ? Excitation::Between::interpolated
         : Plant::topology == "imposed_motion"                     ? Excitation::Between::ahead
                                                                   : Excitation::Between::held;
}

}  // namespace hotfire
