// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace hotfire::model {

/// A sampled continuous signal between its rows, such as a measured force: the polynomial through neighbouring rows
/// (Lagrange). Held, the signal would come half a row late, which at a tenth of the sampling rate is an error of a third of
/// the response. The polynomial goes through six rows, or through as many up to sixteen as it takes until two more change it
/// by less than 0.5 % of the signal's rms: a signal that reaches up to a third of the sampling rate needs twelve. The first
/// and the last value continue beyond the ends. No allocation.
class Interpolation {
 public:
  static constexpr int kMostNodes = 16;
  using Weights = std::array<double, kMostNodes>;

  explicit Interpolation(std::span<const double> values) noexcept : nodes_(nodes_needed(values)) {}

  /// The weights of the rows around a row in the mean over a part of it, from `from` to `to` of its period: eight-point
  /// Gauss, exact to degree 15.
  Weights mean_weights(double from, double to) const noexcept {
    constexpr std::array<double, 4> kAbscissa{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                              0.9602898564975363};
    constexpr std::array<double, 4> kShare{0.1813418916891810, 0.1568533229389437, 0.1111905172266872, 0.0506142681451881};
    Weights mean{};
    for (std::size_t point = 0; point < kAbscissa.size(); ++point) {
      for (const double side : {-1.0, 1.0}) {
        const Weights weights = weights_at(nodes_, 0.5 * (from + to) + 0.5 * (to - from) * side * kAbscissa[point]);
        for (std::size_t node = 0; node < mean.size(); ++node) {
          mean[node] += kShare[point] * weights[node];
        }
      }
    }
    return mean;
  }

  /// The weights of the rows around a row in the value at `part` of its period.
  Weights weights(double part) const noexcept { return weights_at(nodes_, part); }

  /// True if the signal has all rows from which a value after this row is interpolated.
  bool reaches(std::size_t row, std::size_t rows) const noexcept {
    const auto first = static_cast<std::ptrdiff_t>(row) - before(nodes_);
    return first >= 0 && first + nodes_ <= static_cast<std::ptrdiff_t>(rows);
  }

  /// The mean over that part of a row, or the value at it. `values` is the signal, which has at least one row. The weights
  /// apply to what the rows differ from this one: their sum is one only up to rounding, and a constant signal keeps its
  /// value bit for bit.
  double mean(std::span<const double> values, std::size_t row, const Weights& weights) const noexcept {
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) - before(nodes_);
    const double present = values[std::min(row, values.size() - 1)];
    double change = 0.0;
    for (std::ptrdiff_t node = 0; node < nodes_; ++node) {
      const auto at = std::clamp<std::ptrdiff_t>(first + node, 0, last);
      change += weights[static_cast<std::size_t>(node)] * (values[static_cast<std::size_t>(at)] - present);
    }
    return present + change;
  }

  /// Nodes in front of node 0.
  static constexpr std::ptrdiff_t before(int nodes) noexcept { return nodes / 2 - 1; }

  /// Lagrange polynomials of `nodes` nodes -before .. nodes/2 at `t` rows beyond node 0.
  static Weights weights_at(int nodes, double t) noexcept {
    Weights weights{};
    const double first = -static_cast<double>(before(nodes));
    for (int node = 0; node < nodes; ++node) {
      double basis = 1.0;
      for (int other = 0; other < nodes; ++other) {
        if (other != node) {
          basis *= (t - first - other) / (node - other);
        }
      }
      weights[static_cast<std::size_t>(node)] = basis;
    }
    return weights;
  }

 private:
  static constexpr int kFewestNodes = 6;
  static constexpr double kMaterial = 5e-3;

  /// Estimated half-way between rows, where a polynomial is furthest off, at no more than a thousand or two places of the
  /// signal.
  static int nodes_needed(std::span<const double> values) noexcept {
    constexpr std::size_t kPlaces = 1000;
    int nodes = kFewestNodes;
    const std::size_t stride = std::max<std::size_t>(1, values.size() / kPlaces);
    while (nodes < kMostNodes) {
      const Weights fewer = weights_at(nodes, 0.5);
      const Weights more = weights_at(nodes + 2, 0.5);
      double change = 0.0;
      double square = 0.0;
      const auto reach = static_cast<std::size_t>(nodes + 2);
      for (std::size_t first = 0; first + reach <= values.size(); first += stride) {
        double difference = more[0] * values[first] + more[reach - 1] * values[first + reach - 1];
        for (std::size_t node = 1; node + 1 < reach; ++node) {
          difference += (more[node] - fewer[node - 1]) * values[first + node];
        }
        change += difference * difference;
        square += values[first] * values[first];
      }
      if (!(change > kMaterial * kMaterial * square)) {
        return nodes;
      }
      nodes += 2;
    }
    return nodes;
  }

  int nodes_;  ///< neighbouring rows from which a value between two of them is interpolated
};

/// The end of a step of a signal from its means over this step and the one before it: second order where it is smooth.
template <class S>
S end_of_step(const S& mean, const S& mean_before) noexcept {
  return mean + 0.5 * (mean - mean_before);
}

}  // namespace hotfire::model
