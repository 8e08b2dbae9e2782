// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/spectrum.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

namespace hotfire::explain {

namespace {

/// Length of the stretches that a spectrum is averaged over [s]: its bins are one over this apart.
constexpr double kStretchSeconds = 8.0;

/// What one record leaves over, less its mean, on the rows that a fit sees.
struct Left {
  double period = 0.0;
  double rows = 0.0;
  std::vector<std::pair<double, std::vector<double>>> stretches;  ///< time of the first row [s], what is left
};

Left left_on_fitted_rows(const Experiment& experiment, const std::vector<double>& predicted, std::size_t channel) {
  Left record;
  record.period = experiment.period;
  double sum = 0.0;
  for (const Block& block : experiment.fitted) {
    std::vector<double> left;
    for (std::size_t row = block.first; row < block.last; ++row) {
      left.push_back(experiment.measured[channel][row] - predicted[row]);
      sum += left.back();
    }
    record.rows += static_cast<double>(left.size());
    record.stretches.emplace_back(static_cast<double>(block.first) * experiment.period, std::move(left));
  }
  for (auto& [start, left] : record.stretches) {
    for (double& value : left) {
      value -= sum / record.rows;
    }
  }
  return record;
}

/// What a sinusoid of a frequency, at its best phase, takes off the sum of squares, up to a constant factor.
double power_of(const Left& record, double frequency) {
  const double turn = -2.0 * std::numbers::pi * frequency;
  const std::complex<double> step = std::polar(1.0, turn * record.period);
  std::complex<double> sum = 0.0;
  for (const auto& [start, left] : record.stretches) {
    std::complex<double> phase = std::polar(1.0, turn * start);
    for (const double value : left) {
      sum += value * phase;
      phase *= step;
    }
  }
  return std::norm(sum) / record.rows;
}

}  // namespace

std::size_t fast_transform_length(std::size_t least) {
  for (std::size_t length = std::max<std::size_t>(least, 1);; ++length) {
    std::size_t rest = length;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) {
        rest /= factor;
      }
    }
    if (rest == 1) {
      return length;
    }
  }
}

std::vector<double> strongest_frequencies(const Dataset& data,
                                          const std::vector<std::vector<std::vector<double>>>& prediction,
                                          std::size_t channel, std::size_t count) {
  std::vector<std::pair<double, double>> spectrum;  // power, frequency
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    const auto& measured = experiment.measured[channel];
    const auto length = std::min(measured.size(), static_cast<std::size_t>(kStretchSeconds / experiment.period));
    if (length < 16) {
      continue;
    }
    Eigen::FFT<double> transform;
    std::vector<double> power(length / 2, 0.0);
    for (std::size_t first = 0; first + length <= measured.size(); first += length / 2) {
      std::vector<double> windowed(length);
      for (std::size_t i = 0; i < length; ++i) {
        const double hann =
            0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length));
        windowed[i] = hann * (measured[first + i] - prediction[e][channel][first + i]);
      }
      std::vector<std::complex<double>> bins;
      transform.fwd(bins, windowed);
      for (std::size_t k = 0; k < power.size(); ++k) {
        power[k] += std::norm(bins[k]);
      }
    }
    for (std::size_t k = 2; k + 1 < power.size(); ++k) {
      if (power[k] > power[k - 1] && power[k] > power[k + 1]) {
        spectrum.emplace_back(power[k], static_cast<double>(k) / (static_cast<double>(length) * experiment.period));
      }
    }
  }
  std::sort(spectrum.rbegin(), spectrum.rend());
  std::vector<double> found;
  for (const auto& peak : spectrum) {
    const double frequency = peak.second;
    const bool apart =
        std::all_of(found.begin(), found.end(), [&](double other) { return std::abs(std::log2(frequency / other)) > 0.25; });
    if (apart && found.size() < count) {
      found.push_back(frequency);
    }
  }
  return found;
}

std::vector<double> sharpened_frequencies(const Dataset& data,
                                          const std::vector<std::vector<std::vector<double>>>& prediction,
                                          std::size_t channel, std::vector<double> frequencies) {
  std::vector<Left> records;
  double longest = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    if (!experiment.measured[channel].empty() && !experiment.fitted.empty()) {
      records.push_back(left_on_fitted_rows(experiment, prediction[e][channel], channel));
      longest = std::max(longest, static_cast<double>(experiment.rows()) * experiment.period);
    }
  }
  if (records.empty()) {
    return frequencies;
  }
  const auto power_at = [&](double frequency) {
    return std::accumulate(records.begin(), records.end(), 0.0,
                           [&](double power, const Left& record) { return power + power_of(record, frequency); });
  };
  // Four points in a peak as wide as the longest record makes it.
  const double apart = 0.25 / longest;
  const auto reach = static_cast<int>(std::ceil(1.0 / kStretchSeconds / apart));
  for (double& frequency : frequencies) {
    const double center = frequency;
    double most = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const double tried = center + k * apart;
      if (const double power = tried > 0.0 ? power_at(tried) : 0.0; power > most) {
        most = power;
        frequency = tried;
      }
    }
    const double below = power_at(frequency - apart);
    const double above = power_at(frequency + apart);
    const double bend = below - 2.0 * most + above;
    frequency += bend < 0.0 ? std::clamp(0.5 * (below - above) / bend, -0.5, 0.5) * apart : 0.0;
  }
  return frequencies;
}

}  // namespace hotfire::explain
