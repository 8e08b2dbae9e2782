// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/statistics.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

namespace {

std::vector<double> white_noise(std::size_t count, double rms) {
  std::mt19937_64 generator(1967);
  std::normal_distribution<double> normal(0.0, rms);
  std::vector<double> values(count);
  for (double& value : values) {
    value = normal(generator);
  }
  return values;
}

/// First-order autoregression with coefficient a: its statistical inefficiency is (1 + a) / (1 - a).
std::vector<double> coloured_noise(std::size_t count, double a) {
  std::vector<double> values = white_noise(count, 1.0);
  for (std::size_t i = 1; i < count; ++i) {
    values[i] += a * values[i - 1];
  }
  return values;
}

}  // namespace

TEST_GROUP(Statistics){};

TEST(Statistics, NoiseIsEstimatedFromDifferencesUnderASignalAThousandTimesLarger) {
  std::vector<double> values = white_noise(20000, 8e-6);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += 8e-3 * std::sin(2.0 * 3.14159265 * 1.0 * static_cast<double>(i) * 0.002);
  }
  // The third difference of 1 Hz at 500 Hz is (2 pi / 500)^3 of its amplitude: 1.6e-8, far below 8e-6. 312 stretches leave
  // the median within 2 %.
  DOUBLES_EQUAL(8e-6, hotfire::explain::noise_from_differences(values), 0.03 * 8e-6);
}

TEST(Statistics, WhiteNoiseCountsEverySample) {
  // The sum over lags of 20000 samples strays by a few hundredths.
  DOUBLES_EQUAL(1.0, hotfire::explain::statistical_inefficiency(white_noise(20000, 1.0)), 0.1);
}

TEST(Statistics, ColouredNoiseCountsAsItsAutoregressionSays) {
  // (1 + 0.9) / (1 - 0.9) = 19; the estimate from 50000 samples (2600 effective ones) is good to about a tenth.
  DOUBLES_EQUAL(19.0, hotfire::explain::statistical_inefficiency(coloured_noise(50000, 0.9)), 0.2 * 19.0);
}

TEST(Statistics, AutocorrelationOfAnAutoregressionFallsAsItsPowers) {
  const auto rho = hotfire::explain::autocorrelation(coloured_noise(50000, 0.9), 10);
  DOUBLES_EQUAL(1.0, rho[0], 1e-12);
  // Standard error of rho at these lags: about sqrt((1 - a^2) / n) = 0.002 at lag 1, sqrt(19 / n) = 0.02 at most.
  DOUBLES_EQUAL(0.9, rho[1], 0.01);
  DOUBLES_EQUAL(std::pow(0.9, 10), rho[10], 0.06);
}
