// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/welch.hpp"

#include <algorithm>
#include <unsupported/Eigen/FFT>

namespace hotfire::analysis {

namespace {

using Transform = std::vector<std::complex<double>>;

/// Calls `f` with the windowed transforms of every segment of some signals of equal length.
template <class F>
void for_each_segment(const std::vector<std::span<const double>>& signals, Segments segments, F&& f) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  const std::size_t rows = segments.rows;
  std::vector<double> part(rows);
  std::vector<Transform> transforms(signals.size());
  for (std::size_t first = 0; first + rows <= signals.front().size(); first += std::max<std::size_t>(rows / 2, 1)) {
    for (std::size_t s = 0; s < signals.size(); ++s) {
      const std::span<const double> own = signals[s].subspan(first, rows);
      double mean = 0.0;
      for (const double value : own) {
        mean += value / static_cast<double>(rows);
      }
      for (std::size_t k = 0; k < rows; ++k) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(rows);
        part[k] = (own[k] - mean) * (0.5 - 0.5 * std::cos(angle));
      }
      fft.fwd(transforms[s], part);
    }
    f(transforms);
  }
}

}  // namespace

Spectrum welch_spectrum(std::span<const double> signal, double period, Segments segments) {
  Spectrum spectrum;
  const auto rows = static_cast<double>(segments.rows);
  spectrum.resolution = 1.0 / (rows * period);
  spectrum.density.assign(segments.rows / 2 + 1, 0.0);
  double count = 0.0;
  for_each_segment({signal}, segments, [&](const std::vector<Transform>& parts) {
    for (std::size_t k = 0; k < spectrum.density.size(); ++k) {
      spectrum.density[k] += std::norm(parts[0][k]);
    }
    count += 1.0;
  });
  // Both sides in one, over the power of a Hann window, 3/8.
  const double scale = 2.0 * period / (0.375 * rows * std::max(count, 1.0));
  for (double& value : spectrum.density) {
    value *= scale;
  }
  return spectrum;
}

FrequencyResponse welch_response(std::span<const double> input, std::span<const double> output, double period,
                                 Segments segments, double lowest, double highest) {
  const std::size_t bins = segments.rows / 2 + 1;
  std::vector<double> of_input(bins, 0.0);
  std::vector<double> of_output(bins, 0.0);
  Transform across(bins, 0.0);
  for_each_segment({input, output}, segments, [&](const std::vector<Transform>& parts) {
    for (std::size_t k = 0; k < bins; ++k) {
      of_input[k] += std::norm(parts[0][k]);
      of_output[k] += std::norm(parts[1][k]);
      across[k] += std::conj(parts[0][k]) * parts[1][k];
    }
  });
  const double least = 1e-8 * *std::max_element(of_input.begin(), of_input.end());
  FrequencyResponse response;
  for (std::size_t k = 1; k < bins; ++k) {
    const double frequency = static_cast<double>(k) / (static_cast<double>(segments.rows) * period);
    if (frequency >= lowest && frequency <= highest && of_input[k] > least) {
      const double power = of_input[k] * of_output[k];
      response.push_back({frequency, across[k] / of_input[k], power > 0.0 ? std::norm(across[k]) / power : 0.0});
    }
  }
  return response;
}

FrequencyResponse periodic_response(std::span<const double> input, std::span<const double> output, double period,
                                    double lowest, double highest) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  const auto transformed = [&fft](std::span<const double> signal) {
    Transform transform;
    fft.fwd(transform, std::vector<double>(signal.begin(), signal.end()));
    return transform;
  };
  const Transform of_input = transformed(input);
  const Transform of_output = transformed(output);
  double largest = 0.0;
  for (std::size_t k = 1; k < of_input.size(); ++k) {
    largest = std::max(largest, std::abs(of_input[k]));
  }
  FrequencyResponse response;
  for (std::size_t k = 1; k < of_input.size(); ++k) {
    const double frequency = static_cast<double>(k) / (static_cast<double>(input.size()) * period);
    if (frequency >= lowest && frequency <= highest && std::abs(of_input[k]) > 1e-4 * largest) {
      response.push_back({frequency, of_output[k] / of_input[k], 1.0});
    }
  }
  return response;
}

}  // namespace hotfire::analysis
