// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/held_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// A start is remembered for longer than the axis does if it takes this factor of the rows. The axis alone forgets it to a
/// ten-thousandth of a step, which is less than its sensors resolve.
constexpr double kRememberedLonger = 1.2;

double rms_about_mean(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  const double square = std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / count;
  return std::sqrt(std::max(0.0, square - mean * mean));
}

/// The records with the first command moved by a share of its rms, and with zeros that are known.
Dataset started_beside(Dataset data, double share) {
  for (Experiment& experiment : data.experiments) {
    experiment.input.front() += share * rms_about_mean(experiment.input);
    experiment.zero_deviation.assign(data.channels.size(), 0.0);
  }
  return data;
}

/// Rows of an experiment until two predictions of it differ by less than a sensor shows.
std::size_t rows_of_difference(const Dataset& data, std::size_t e, const Prediction& one, const Prediction& other) {
  const Experiment& experiment = data.experiments[e];
  std::size_t rows = 0;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    for (std::size_t row = experiment.rows(); data.used[c] && row-- > rows;) {
      if (std::abs(one[e][c][row] - other[e][c][row]) > policy().immaterial * experiment.noise[c]) {
        rows = row + 1;
      }
    }
  }
  return rows;
}

/// Where the last held-out block of an experiment begins: it stays.
std::size_t last_held_out(const Experiment& experiment) {
  std::size_t first = experiment.held_out.empty() ? experiment.rows() : 0;
  for (const Block& block : experiment.held_out) {
    first = std::max(first, block.first);
  }
  return first;
}

}  // namespace

bool forget_held_starts(const Fitted& model, unsigned threads, Dataset& data) {
  const bool any_moves = std::ranges::any_of(data.experiments, [](const Experiment& e) { return e.first_scored > 0; });
  if (!any_moves || !is_hydraulic_axis(model.base)) {
    return false;
  }
  const Dataset below = started_beside(data, -1.0);
  const Dataset above = started_beside(data, 1.0);
  Prediction from_below;
  Prediction from_above;
  if (!Evaluator(below, Resolution::coarse).predict(model.base, model.free, model.u, threads, from_below) ||
      !Evaluator(above, Resolution::coarse).predict(model.base, model.free, model.u, threads, from_above)) {
    return false;
  }
  bool any = false;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    Experiment& experiment = data.experiments[e];
    const std::size_t most = std::min(experiment.rows() / 2, last_held_out(experiment));
    const std::size_t rows = std::min(most, rows_of_difference(data, e, from_below, from_above));
    if (experiment.first_scored > 0 &&
        static_cast<double>(rows) > kRememberedLonger * static_cast<double>(experiment.first_scored)) {
      forget_start(experiment, rows);
      any = true;
    }
  }
  return any;
}

}  // namespace hotfire::explain
