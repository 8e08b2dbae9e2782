// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/resonance.hpp"

#include <algorithm>
#include <array>

namespace hotfire::analysis {

namespace {

/// Where the parabola through three points has its vertex, held between the outer two.
double vertex(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]);
  const double right = (y[2] - y[1]) / (x[2] - x[1]);
  const double curvature = (right - left) / (x[2] - x[0]);
  if (curvature == 0.0) {
    return x[1];
  }
  return std::clamp(0.5 * (x[0] + x[1]) - 0.5 * left / curvature, x[0], x[2]);
}

/// Frequency of an extremum of `value` at point k, over frequency^2.
template <class Value>
double extremum(const FrequencyResponse& response, std::size_t k, Value&& value) {
  std::array<double, 3> squared{};
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const ResponsePoint& point = response[k - 1 + i];
    squared[i] = point.frequency * point.frequency;
    values[i] = value(std::norm(point.gain));
  }
  return std::sqrt(vertex(squared, values));
}

FrequencyResponse within(const FrequencyResponse& response, double lowest, double highest) {
  FrequencyResponse band;
  std::copy_if(response.begin(), response.end(), std::back_inserter(band),
               [&](const ResponsePoint& point) { return point.frequency >= lowest && point.frequency <= highest; });
  return band;
}

}  // namespace

std::optional<Notch> find_notch(const FrequencyResponse& response, double lowest, double highest) {
  const FrequencyResponse band = within(response, lowest, highest);
  std::optional<Notch> deepest;
  double shoulder = -1e300;
  for (std::size_t k = band.size(); k-- > 0;) {
    const double gain = gain_decibels(band[k]);
    const bool inside = k > 0 && k + 1 < band.size();
    if (inside && gain < gain_decibels(band[k - 1]) && gain <= gain_decibels(band[k + 1]) &&
        (!deepest || shoulder - gain > deepest->depth)) {
      deepest = Notch{extremum(band, k, [](double power) { return power; }), gain, shoulder - gain};
    }
    shoulder = std::max(shoulder, gain);
  }
  return deepest;
}

std::optional<Peak> find_peak(const FrequencyResponse& response, double lowest, double highest) {
  const FrequencyResponse band = within(response, lowest, highest);
  std::optional<Peak> highest_peak;
  for (std::size_t k = 1; k + 1 < band.size(); ++k) {
    const double gain = gain_decibels(band[k]);
    if (gain > gain_decibels(band[k - 1]) && gain >= gain_decibels(band[k + 1]) &&
        (!highest_peak || gain > highest_peak->gain)) {
      highest_peak = Peak{extremum(band, k, [](double power) { return 1.0 / power; }), gain};
    }
  }
  return highest_peak;
}

std::optional<Peak> find_peak(const Spectrum& spectrum, double lowest, double highest) {
  FrequencyResponse amplitudes;
  for (std::size_t k = 0; k < spectrum.density.size(); ++k) {
    amplitudes.push_back({static_cast<double>(k) * spectrum.resolution, std::sqrt(spectrum.density[k]), 1.0});
  }
  return find_peak(amplitudes, lowest, highest);
}

}  // namespace hotfire::analysis
