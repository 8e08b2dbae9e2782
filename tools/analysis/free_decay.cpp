// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/free_decay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hotfire::analysis {

std::optional<FreeDecay> free_decay(std::span<const double> signal, double period, double seconds) {
  constexpr double kLeast = 0.05;
  constexpr std::size_t kFewestHalfCycles = 6;
  const std::size_t rows = std::min(signal.size(), static_cast<std::size_t>(seconds / period) + 1);
  std::vector<double> crossings;
  std::vector<double> extremes{0.0};
  double largest = 0.0;
  for (std::size_t k = 1; k < rows; ++k) {
    extremes.back() = std::max(extremes.back(), std::abs(signal[k]));
    largest = std::max(largest, extremes.back());
    if (signal[k - 1] * signal[k] < 0.0 || (signal[k] == 0.0 && signal[k - 1] != 0.0)) {
      if (!crossings.empty() && extremes.back() < kLeast * largest) {
        break;
      }
      crossings.push_back(static_cast<double>(k - 1) + signal[k - 1] / (signal[k - 1] - signal[k]));
      extremes.push_back(0.0);
    }
  }
  if (crossings.size() < kFewestHalfCycles + 1) {
    return std::nullopt;
  }
  const auto half_cycles = static_cast<double>(crossings.size() - 1);
  FreeDecay decay;
  decay.frequency = 0.5 * half_cycles / ((crossings.back() - crossings.front()) * period);
  decay.cycles = static_cast<int>(half_cycles / 2.0);
  // extremes[1] lies between the first two crossings.
  const double decrement = std::log(extremes[1] / extremes[crossings.size() - 1]) / (half_cycles - 1.0);
  decay.damping_ratio = decrement / std::hypot(decrement, std::numbers::pi);
  return decay;
}

}  // namespace hotfire::analysis
