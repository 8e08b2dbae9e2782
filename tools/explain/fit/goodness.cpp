// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/goodness.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/explain/data/statistics.hpp"

namespace hotfire::explain {

namespace {

/// Sums over blocks of rows, turned into a ChannelFit at the end.
struct Sums {
  double rows = 0.0;
  double square = 0.0;
  double inflated = 0.0;
  double over_noise = 0.0;  ///< sum of squares of residual over noise
  double sum = 0.0;
  double max = 0.0;
  double measured = 0.0;
  double measured_square = 0.0;

  void add(const std::vector<double>& predicted, const std::vector<double>& measured_values, double noise, Block block) {
    std::vector<double> residual;
    residual.reserve(block.last - block.first);
    double block_square = 0.0;
    for (std::size_t row = block.first; row < block.last; ++row) {
      const double r = predicted[row] - measured_values[row];
      residual.push_back(r);
      block_square += r * r;
      sum += r;
      max = std::max(max, std::abs(r));
      measured += measured_values[row];
      measured_square += measured_values[row] * measured_values[row];
    }
    rows += static_cast<double>(residual.size());
    square += block_square;
    over_noise += block_square / (noise * noise);
    inflated += block_square / (noise * noise) * statistical_inefficiency(residual);
  }

  ChannelFit result() const {
    ChannelFit fit;
    if (rows <= 0.0) {
      return fit;
    }
    fit.rows = rows;
    fit.effective_rows = inflated > 0.0 ? rows * over_noise / inflated : rows;
    fit.mean_square = over_noise / rows;
    fit.rms = std::sqrt(square / rows);
    fit.max = max;
    fit.bias = sum / rows;
    const double spread = measured_square - measured * measured / rows;
    fit.fit_percent = spread > 0.0 ? 100.0 * (1.0 - std::sqrt(square / spread)) : 0.0;
    return fit;
  }
};

}  // namespace

double Goodness::combined(const std::vector<ChannelFit>& part) {
  double square = 0.0;
  double rows = 0.0;
  for (const ChannelFit& channel : part) {
    square += channel.mean_square * channel.rows;
    rows += channel.rows;
  }
  return rows > 0.0 ? std::sqrt(square / rows) : 0.0;
}

Goodness goodness(const Dataset& data, const Prediction& prediction) {
  Goodness result;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    Sums fitted;
    Sums held;
    for (std::size_t e = 0; e < data.experiments.size(); ++e) {
      const Experiment& experiment = data.experiments[e];
      if (experiment.measured[c].empty()) {
        continue;
      }
      for (const Block& block : experiment.fitted) {
        fitted.add(prediction[e][c], experiment.measured[c], experiment.noise[c], block);
      }
      for (const Block& block : experiment.held_out) {
        held.add(prediction[e][c], experiment.measured[c], experiment.noise[c], block);
      }
    }
    result.fitted.push_back(fitted.result());
    result.held_out.push_back(held.result());
  }
  return result;
}

double error_ratio(const std::vector<ChannelFit>& with, const std::vector<ChannelFit>& without) {
  double logarithms = 0.0;
  double channels = 0.0;
  for (std::size_t c = 0; c < with.size(); ++c) {
    const double before = without[c].mean_square;
    if (before > 0.0) {
      logarithms += 0.5 * std::log(with[c].mean_square / before);
      channels += 1.0;
    }
  }
  const double combined = Goodness::combined(with) / Goodness::combined(without);
  return channels > 0.0 ? std::min(combined, std::exp(logarithms / channels)) : combined;
}

double information_criterion(const std::vector<ChannelFit>& part, const std::vector<ChannelFit>& effective,
                             std::size_t parameters) {
  double criterion = 0.0;
  double samples = 0.0;
  for (std::size_t c = 0; c < part.size(); ++c) {
    if (part[c].rows > 0.0 && part[c].mean_square > 0.0) {
      criterion += effective[c].effective_rows * std::log(part[c].mean_square);
      samples += effective[c].effective_rows;
    }
  }
  return criterion + static_cast<double>(parameters) * std::log(std::max(2.0, samples));
}

std::vector<double> residual_of(const Experiment& experiment, const std::vector<double>& predicted, std::size_t channel,
                                Block block) {
  std::vector<double> residual;
  residual.reserve(block.last - block.first);
  for (std::size_t row = block.first; row < block.last; ++row) {
    residual.push_back(experiment.measured[channel][row] - predicted[row]);
  }
  return residual;
}

std::vector<double> scored_residual(const Experiment& experiment, const std::vector<std::vector<double>>& predicted,
                                    std::size_t channel) {
  std::vector<double> residual;
  if (experiment.measured[channel].empty()) {
    return residual;
  }
  for (const Block& block : experiment.scored()) {
    const std::vector<double> part = residual_of(experiment, predicted[channel], channel, block);
    residual.insert(residual.end(), part.begin(), part.end());
  }
  return residual;
}

double excess_over_noise(const Dataset& data, const Prediction& prediction, std::size_t channel) {
  double over_noise = 0.0;
  double rows = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const std::vector<double> residual = scored_residual(data.experiments[e], prediction[e], channel);
    if (residual.empty()) {
      continue;
    }
    const auto count = static_cast<double>(residual.size());
    const double seen = noise_from_differences(residual);
    const double least = data.noise_source[channel] == NoiseSource::estimated ? 0.0 : data.experiments[e].noise[channel];
    const double noise = std::max(seen, least);
    const double square = std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0);
    over_noise += noise > 0.0 ? square / (noise * noise) : 0.0;
    rows += count;
  }
  return rows > 0.0 ? std::sqrt(std::max(0.0, over_noise / rows - 1.0)) : 0.0;
}

double excess_over_noise(const Dataset& data, const Prediction& prediction) {
  double largest = 0.0;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    largest = data.used[c] ? std::max(largest, excess_over_noise(data, prediction, c)) : largest;
  }
  return largest;
}

std::vector<double> difference_over_noise(const Dataset& data, const Prediction& one, const Prediction& other) {
  std::vector<double> difference(data.channels.size(), 0.0);
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    double square = 0.0;
    double rows = 0.0;
    for (std::size_t e = 0; e < data.experiments.size(); ++e) {
      const Experiment& experiment = data.experiments[e];
      if (experiment.measured[c].empty()) {
        continue;
      }
      for (const Block& block : experiment.scored()) {
        for (std::size_t row = block.first; row < block.last; ++row) {
          const double apart = (one[e][c][row] - other[e][c][row]) / experiment.noise[c];
          square += apart * apart;
          rows += 1.0;
        }
      }
    }
    difference[c] = rows > 0.0 ? std::sqrt(square / rows) : 0.0;
  }
  return difference;
}

}  // namespace hotfire::explain
