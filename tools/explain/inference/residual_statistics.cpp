// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/residual_statistics.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <numeric>

#include "tools/explain/data/statistics.hpp"

namespace hotfire::explain {

namespace {

/// 99 % of a normal distribution.
constexpr double kTwoSided99 = 2.575829;
/// At 99 % bounds one lag in a hundred is outside by chance; more than three are not, nor is one that is 4.1 standard
/// deviations off, which chance does in one of 260 hundreds of lags.
constexpr std::size_t kOutsideByChance = 3;
constexpr double kFarOutside = 1.6;
/// Length of the stretches that are sorted by their amplitude [s].
constexpr double kPartSeconds = 1.0;
/// Octaves of amplitude below the largest; what is smaller is in the last of them.
constexpr int kOctaves = 7;

/// The input less its mean over the record.
std::vector<double> centred_input(const Experiment& experiment) {
  std::vector<double> input = experiment.input;
  const double mean = std::accumulate(input.begin(), input.end(), 0.0) / std::max(1.0, static_cast<double>(input.size()));
  for (double& value : input) {
    value -= mean;
  }
  return input;
}

/// Upper edges of the bands below the highest frequency, that itself at the end [Hz].
std::vector<double> band_edges(double highest) {
  std::vector<double> edges;
  for (const double low : {0.5, 1.0}) {
    if (low < highest) {
      edges.push_back(low);
    }
  }
  for (int k = 1; std::exp2(0.5 * k) < highest; ++k) {
    edges.push_back(std::exp2(0.5 * k));
  }
  edges.push_back(highest);
  return edges;
}

double nyquist(const Experiment& experiment) { return 0.5 / experiment.period; }

/// Adds the square of a block's residual, times its rows, to the bands in which it lies.
void add_spectrum(const std::vector<double>& residual, double period, const std::vector<double>& edges,
                  std::vector<double>& squares) {
  const auto rows = static_cast<double>(residual.size());
  std::vector<double> windowed(residual.size());
  double window_square = 0.0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const double hann = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / rows);
    windowed[i] = hann * residual[i];
    window_square += hann * hann;
  }
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> bins;
  transform.fwd(bins, windowed);
  for (std::size_t k = 0; k <= residual.size() / 2; ++k) {
    const double frequency = static_cast<double>(k) / (rows * period);
    const bool has_mirror = k != 0 && 2 * k != residual.size();
    const auto band = std::min(edges.end() - 1, std::upper_bound(edges.begin(), edges.end(), frequency));
    // |X|^2 / (n sum w^2) is the share of the mean square; times n rows.
    squares[static_cast<std::size_t>(band - edges.begin())] += (has_mirror ? 2.0 : 1.0) * std::norm(bins[k]) / window_square;
  }
}

double half_peak_to_peak(const std::vector<double>& values, Block block) {
  const auto [low, high] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(block.first),
                                               values.begin() + static_cast<std::ptrdiff_t>(block.last));
  return 0.5 * (*high - *low);
}

}  // namespace

bool Correlation::is_none() const {
  std::size_t outside = 0;
  bool is_far = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double over = lags[i] > 0.0 ? std::abs(values[i]) / bound99 : 0.0;
    outside += over > 1.0 ? 1 : 0;
    is_far = is_far || over > kFarOutside;
  }
  return outside <= kOutsideByChance && !is_far;
}

Correlation residual_autocorrelation(const Dataset& data, const Prediction& prediction, std::size_t channel) {
  Correlation all;
  all.values.assign(kLags + 1, 0.0);
  double rows = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const std::vector<double> residual = scored_residual(data.experiments[e], prediction[e], channel);
    if (residual.size() <= 2 * kLags) {
      continue;
    }
    const auto count = static_cast<double>(residual.size());
    const std::vector<double> rho = autocorrelation(residual, kLags);
    for (std::size_t lag = 0; lag <= kLags; ++lag) {
      all.values[lag] += rho[lag] * count;
    }
    rows += count;
  }
  for (std::size_t lag = 0; lag <= kLags; ++lag) {
    all.values[lag] = rows > 0.0 ? all.values[lag] / rows : 0.0;
    all.lags.push_back(static_cast<double>(lag) * data.experiments.front().period);
  }
  all.bound99 = kTwoSided99 / std::sqrt(std::max(1.0, rows));
  return all;
}

Correlation input_correlation(const Dataset& data, const Prediction& prediction, std::size_t channel) {
  Correlation all;
  all.values.assign(kLags, 0.0);
  double residual_square = 0.0;
  double input_square = 0.0;
  double rows = 0.0;
  double inflated = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    if (experiment.measured[channel].empty()) {
      continue;
    }
    const std::vector<double> input = centred_input(experiment);
    std::vector<double> residuals;
    std::vector<double> inputs;
    for (const Block& block : experiment.scored()) {
      for (std::size_t row = std::max(block.first, kLags); row < block.last; ++row) {
        residuals.push_back(experiment.measured[channel][row] - prediction[e][channel][row]);
        inputs.push_back(input[row]);
        for (std::size_t lag = 1; lag <= kLags; ++lag) {
          all.values[lag - 1] += residuals.back() * input[row - lag];
        }
      }
    }
    const auto count = static_cast<double>(residuals.size());
    residual_square += std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
    input_square += std::inner_product(inputs.begin(), inputs.end(), inputs.begin(), 0.0);
    inflated += count * joint_inefficiency(residuals, inputs);
    rows += count;
  }
  const double scale = std::sqrt(residual_square * input_square);
  for (std::size_t lag = 1; lag <= kLags; ++lag) {
    all.values[lag - 1] = scale > 0.0 ? all.values[lag - 1] / scale : 0.0;
    all.lags.push_back(static_cast<double>(lag) * data.experiments.front().period);
  }
  all.bound99 = rows > 0.0 ? kTwoSided99 * std::sqrt(inflated) / rows : 1.0;
  return all;
}

std::vector<Band> error_by_frequency(const Dataset& data, const Prediction& prediction, std::size_t channel) {
  double highest = 0.0;
  for (const Experiment& experiment : data.experiments) {
    highest = std::max(highest, nyquist(experiment));
  }
  const std::vector<double> edges = band_edges(highest);
  std::vector<double> squares(edges.size(), 0.0);
  std::vector<double> noise(edges.size(), 0.0);
  double rows = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    if (experiment.measured[channel].empty()) {
      continue;
    }
    for (const Block& block : experiment.held_out) {
      const auto count = static_cast<double>(block.last - block.first);
      add_spectrum(residual_of(experiment, prediction[e][channel], channel, block), experiment.period, edges, squares);
      for (std::size_t band = 0; band < edges.size(); ++band) {
        const double from = band == 0 ? 0.0 : edges[band - 1];
        const double width = std::max(0.0, std::min(edges[band], nyquist(experiment)) - from);
        noise[band] += count * experiment.noise[channel] * experiment.noise[channel] * width / nyquist(experiment);
      }
      rows += count;
    }
  }
  std::vector<Band> bands;
  for (std::size_t band = 0; rows > 0.0 && band < edges.size(); ++band) {
    bands.push_back(
        {band == 0 ? 0.0 : edges[band - 1], edges[band], std::sqrt(squares[band] / rows), std::sqrt(noise[band] / rows)});
  }
  return bands;
}

std::vector<AmplitudeRange> error_by_amplitude(const Dataset& data, const Prediction& prediction, std::size_t channel) {
  struct Part {
    double amplitude = 0.0;
    double seconds = 0.0;
    double square = 0.0;  ///< mean
  };
  std::vector<Part> parts;
  double largest = 0.0;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    if (experiment.measured[channel].empty()) {
      continue;
    }
    const auto length = static_cast<std::size_t>(std::max(1L, std::lround(kPartSeconds / experiment.period)));
    for (const Block& block : experiment.held_out) {
      for (std::size_t first = block.first; first < block.last; first += length) {
        const Block rows_of_part{first, std::min(block.last, first + length)};
        const std::vector<double> residual = residual_of(experiment, prediction[e][channel], channel, rows_of_part);
        const auto rows = static_cast<double>(residual.size());
        parts.push_back({half_peak_to_peak(experiment.measured[channel], rows_of_part), rows * experiment.period,
                         std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0) / rows});
        largest = std::max(largest, parts.back().amplitude);
      }
    }
  }
  std::map<int, AmplitudeRange> ranges;  // by octaves below the largest, negative: in the order of their amplitudes
  for (const Part& part : parts) {
    const double below = part.amplitude > 0.0 ? std::floor(std::log2(largest / part.amplitude)) : kOctaves;
    const int octave = static_cast<int>(std::min<double>(below, kOctaves));
    AmplitudeRange& range = ranges[-octave];
    range.from = octave == kOctaves ? 0.0 : std::ldexp(largest, -octave - 1);
    range.to = std::ldexp(largest, -octave);
    range.rms += part.square * part.seconds;
    range.seconds += part.seconds;
  }
  std::vector<AmplitudeRange> result;
  for (auto& [octave, range] : ranges) {
    range.rms = std::sqrt(range.rms / range.seconds);
    result.push_back(range);
  }
  return result;
}

}  // namespace hotfire::explain
