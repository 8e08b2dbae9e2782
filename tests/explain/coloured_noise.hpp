// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace hotfire::test {

/// Noise of rms 1 that forgets itself by `stays` from row to row, stationary from the first on; white with 0.
inline std::vector<double> coloured_noise(std::size_t rows, double stays, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  double value = normal(generator);
  for (std::size_t i = 0; i < rows; ++i) {
    values.push_back(value);
    value = stays * value + std::sqrt(1.0 - stays * stays) * normal(generator);
  }
  return values;
}

}  // namespace hotfire::test
