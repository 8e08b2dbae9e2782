#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace hotfire {

/// What drives a plant between the rows of a record.
///
/// A command is held between rows: that is what a controller does. A measured force is a sampled continuous signal: held, it
/// would come half a row late, which at a tenth of the sampling rate is an error of a third of the response. It is
/// interpolated by the polynomial through six neighbouring rows (Lagrange, degree 5) and each plant step gets the mean over
/// its own part of the row; the first and last value continue beyond the ends.
class Excitation {
 public:
  enum class Between { held, interpolated };

  Excitation(std::span<const double> values, int steps, Between between) : values_(values), between_(between) {
    if (between == Between::interpolated) {
      for (int step = 0; step < steps; ++step) {
        weights_.push_back(mean_weights(static_cast<double>(step) / steps, static_cast<double>(step + 1) / steps));
      }
    }
  }

  std::size_t rows() const { return values_.size(); }

  /// Mean of the input over plant step `step` of a row.
  double operator()(std::size_t row, int step) const {
    if (between_ == Between::held) {
      return values_[row];
    }
    const auto last = static_cast<std::ptrdiff_t>(values_.size()) - 1;
    double mean = 0.0;
    for (std::ptrdiff_t node = 0; node < kNodes; ++node) {
      const auto at = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(row) + node - kBefore, 0, last);
      mean +=
          weights_[static_cast<std::size_t>(step)][static_cast<std::size_t>(node)] * values_[static_cast<std::size_t>(at)];
    }
    return mean;
  }

 private:
  static constexpr std::ptrdiff_t kNodes = 6;
  static constexpr std::ptrdiff_t kBefore = 2;

  /// Mean of each Lagrange polynomial on the nodes -2 .. 3 over [from, to]: three-point Gauss, exact to degree 5.
  static std::array<double, kNodes> mean_weights(double from, double to) {
    constexpr std::array<double, 3> kAbscissa{-0.7745966692414834, 0.0, 0.7745966692414834};
    constexpr std::array<double, 3> kShare{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    std::array<double, kNodes> weights{};
    for (std::size_t point = 0; point < kAbscissa.size(); ++point) {
      const double t = 0.5 * (from + to) + 0.5 * (to - from) * kAbscissa[point];
      for (std::ptrdiff_t node = 0; node < kNodes; ++node) {
        double basis = 1.0;
        for (std::ptrdiff_t other = 0; other < kNodes; ++other) {
          if (other != node) {
            basis *= (t - static_cast<double>(other - kBefore)) / static_cast<double>(node - other);
          }
        }
        weights[static_cast<std::size_t>(node)] += kShare[point] * basis;
      }
    }
    return weights;
  }

  std::span<const double> values_;
  Between between_;
  std::vector<std::array<double, kNodes>> weights_;
};

/// How the input of a plant goes on between rows: a `direct` mass is driven by a measured force, a hydraulic axis by a
/// command.
template <class Plant>
constexpr Excitation::Between between_rows() {
  return Plant::topology == "direct" ? Excitation::Between::interpolated : Excitation::Between::held;
}

}  // namespace hotfire
