// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/residual_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/explain/coloured_noise.hpp"

namespace {

using namespace hotfire::explain;

constexpr std::size_t kRows = 20'000;
constexpr double kPeriod = 0.002;

std::vector<double> noise(double stays, unsigned seed) { return hotfire::test::coloured_noise(kRows, stays, seed); }

/// A record whose model says that nothing moves: what is measured is what is left. Every fourth 2000 rows are held out.
Dataset record(std::vector<double> input, std::vector<double> measured) {
  Dataset data;
  data.channels = {"piston"};
  data.used = {true};
  data.noise = {1.0};
  data.noise_source = {NoiseSource::declared};
  Experiment experiment;
  experiment.period = kPeriod;
  experiment.input = std::move(input);
  experiment.measured = {std::move(measured)};
  for (std::size_t first = 0; first < kRows; first += 2000) {
    (first / 2000 % 4 == 1 ? experiment.held_out : experiment.fitted).push_back({first, first + 2000});
  }
  experiment.noise = data.noise;
  experiment.zero_deviation.assign(data.channels.size(), 0.0);
  data.experiments.push_back(experiment);
  return data;
}

const Prediction kStill{{std::vector<double>(kRows, 0.0)}};

std::vector<double> sine(double amplitude, double frequency) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kRows; ++i) {
    values.push_back(amplitude * std::sin(2.0 * std::numbers::pi * frequency * kPeriod * static_cast<double>(i)));
  }
  return values;
}

}  // namespace

TEST_GROUP(ResidualStatistics){};

TEST(ResidualStatistics, NoiseIsRelatedNeitherToItselfNorToTheInput) {
  const Dataset data = record(noise(0.99, 1), noise(0.0, 2));
  CHECK_TRUE(residual_autocorrelation(data, kStill, 0).is_none());
  CHECK_TRUE(input_correlation(data, kStill, 0).is_none());
}

TEST(ResidualStatistics, ATwentiethOfTheInputTenRowsLateIsSeenThere) {
  const std::vector<double> input = noise(0.5, 1);
  std::vector<double> measured = noise(0.0, 2);
  for (std::size_t i = 10; i < kRows; ++i) {
    measured[i] += 0.05 * input[i - 10];
  }
  const Correlation correlation = input_correlation(record(input, measured), kStill, 0);
  CHECK_FALSE(correlation.is_none());
  const auto largest = std::max_element(correlation.values.begin(), correlation.values.end());
  DOUBLES_EQUAL(10 * kPeriod, correlation.lags[static_cast<std::size_t>(largest - correlation.values.begin())], 1e-12);
  // Told to 1 / sqrt(n), 0.007: four deviations.
  DOUBLES_EQUAL(0.05, *largest, 0.03);
}

// Two slow series look alike by chance: with the bound of white noise nearly all of these pairs would be called related. At
// 99 % bounds one pair in a hundred is outside at all lags together; of thirty, three are outside once in 300 runs.
TEST(ResidualStatistics, SlowNoiseIsNotTakenForAnAnswerToASlowInput) {
  int related = 0;
  int would_be = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    Correlation correlation = input_correlation(record(noise(0.98, 100 + seed), noise(0.98, 200 + seed)), kStill, 0);
    related += correlation.is_none() ? 0 : 1;
    correlation.bound99 = 2.576 / std::sqrt(static_cast<double>(kRows));
    would_be += correlation.is_none() ? 0 : 1;
  }
  CHECK_TRUE(related <= 3);
  CHECK_TRUE(would_be >= 20);
}

TEST(ResidualStatistics, TheSquaresOfAllBandsAreTheSquareOfTheResidual) {
  const Dataset data = record(noise(0.0, 1), noise(0.7, 2));
  double sum = 0.0;
  for (const Band& band : error_by_frequency(data, kStill, 0)) {
    sum += band.rms * band.rms;
  }
  // The window weighs the rows of the three blocks unevenly: 6000 count as half of them, which with a memory of 0.7 tell a
  // mean square to 4.4 %; three deviations.
  DOUBLES_EQUAL(1.0, sum, 0.13);
}

TEST(ResidualStatistics, ASinusoidIsInTheBandOfItsFrequencyAndWhiteNoiseInAllByTheirWidth) {
  for (const Band& band : error_by_frequency(record(noise(0.0, 1), sine(1.0, 5.0)), kStill, 0)) {
    DOUBLES_EQUAL(band.from <= 5.0 && 5.0 < band.to ? std::sqrt(0.5) : 0.0, band.rms, 0.01);
  }
  double expected = 0.0;
  for (const Band& band : error_by_frequency(record(noise(0.0, 1), noise(0.0, 2)), kStill, 0)) {
    // Three blocks of 4 s have 4 * width bins each, two thirds of them independent under the window, which tell an rms to
    // 0.5 / sqrt(8 * width): four deviations.
    if (band.to > 8.0) {
      DOUBLES_EQUAL(1.0, band.rms / band.noise, 2.0 / std::sqrt(8.0 * (band.to - band.from)));
    }
    expected += band.noise * band.noise;
  }
  DOUBLES_EQUAL(1.0, expected, 1e-9);
}

TEST(ResidualStatistics, AnErrorThatGrowsWithTheMotionIsSeenByAmplitude) {
  // The first of three held-out blocks has an amplitude of 1, the others of a tenth; the error is a tenth of the motion.
  std::vector<double> measured = sine(1.0, 5.0);
  for (std::size_t i = 8000; i < kRows; ++i) {
    measured[i] *= 0.1;
  }
  Prediction prediction{{measured}};
  for (double& value : prediction[0][0]) {
    value *= 0.9;
  }
  const auto ranges = error_by_amplitude(record(noise(0.0, 1), measured), prediction, 0);
  CHECK_EQUAL(2U, ranges.size());
  const double rms = 0.1 * std::sqrt(0.5);
  DOUBLES_EQUAL(0.1 * rms, ranges[0].rms, 1e-3 * rms);
  DOUBLES_EQUAL(rms, ranges[1].rms, 1e-3 * rms);
  CHECK_TRUE(ranges[0].from < 0.1 && 0.1 < ranges[0].to && ranges[1].to >= 1.0 && ranges[1].from > 0.2);
  DOUBLES_EQUAL(8.0, ranges[0].seconds, 1e-9);
  DOUBLES_EQUAL(4.0, ranges[1].seconds, 1e-9);
}
