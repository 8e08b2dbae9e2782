// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/spectrum.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <CppUTest/TestHarness.h>

namespace {

constexpr double kSpectrumPeriod = 2e-3;
constexpr double kSpectrumNoise = 8e-6;

hotfire::Record record(const char* name, std::size_t rows, double frequency, double phase, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, kSpectrumNoise);
  hotfire::Record result;
  result.name = name;
  result.path = name;
  result.period = kSpectrumPeriod;
  result.rows = rows;
  std::vector<double> piston;
  for (std::size_t row = 0; row < rows; ++row) {
    piston.push_back(2.0 * kSpectrumNoise *
                         std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(row) * kSpectrumPeriod + phase) +
                     normal(generator));
  }
  result.channels = {{"command", "rad", std::vector<double>(rows, 0.0)}, {"piston", "m", piston}};
  return result;
}

}  // namespace

TEST_GROUP(Spectrum){};

// A sinusoid of 1.4 times the noise's rms in 45,000 fitted rows has its frequency told to sqrt(6) / (pi T) / (snr
// sqrt(rows)) (Rife and Boorstyn 1974), 4e-5 Hz; what is asked is that a fit can start from it: a twentieth of a cycle over
// the longest record, 8e-4 Hz, where the averaged spectrum's bins are 0.125 Hz apart.
TEST(Spectrum, ASinusoidIsIdentifiedToASmallPartOfACycleOverTheLongestRecord) {
  hotfire::ModelFile model;
  model.parameters = hotfire::SimplexParameters{};
  model.noise = {{"piston", kSpectrumNoise}};
  for (const double frequency : {1.37, 5.043, 13.3074}) {
    const auto data = hotfire::explain::make_dataset(
        model, {record("a.csv", 30000, frequency, 0.3, 1), record("b.csv", 15000, frequency, 2.0, 2)});
    const std::vector<std::vector<double>> still(data.channels.size(), std::vector<double>(30000, 0.0));
    const std::vector prediction(2, still);
    const auto strongest = hotfire::explain::strongest_frequencies(data, prediction, 0, 1);
    CHECK_EQUAL(std::size_t{1}, strongest.size());
    const auto sharpened = hotfire::explain::sharpened_frequencies(data, prediction, 0, strongest);
    constexpr double kLongest = 30000 * kSpectrumPeriod;
    DOUBLES_EQUAL(frequency, sharpened.front(), 0.05 / kLongest);
  }
}
