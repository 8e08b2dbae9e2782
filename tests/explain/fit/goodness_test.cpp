// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/goodness.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "tests/explain/coloured_noise.hpp"

namespace {

using namespace hotfire::explain;

constexpr std::size_t kRows = 20'000;

/// A piston that stands still, read with noise of rms 1 that forgets itself by `stays` from row to row; the declared noise
/// is `declared`, or not declared if that is zero.
Dataset standing_piston(double stays, double declared) {
  Dataset data;
  data.channels = {"piston"};
  data.used = {true};
  data.noise = {declared > 0.0 ? declared : 1.0};
  data.noise_source = {declared > 0.0 ? NoiseSource::declared : NoiseSource::estimated};
  Experiment experiment;
  experiment.period = 0.002;
  experiment.input.assign(kRows, 0.0);
  experiment.measured = {hotfire::test::coloured_noise(kRows, stays, 7)};
  experiment.fitted = {{0, kRows}};
  experiment.noise = data.noise;
  experiment.zero_deviation.assign(data.channels.size(), 0.0);
  data.experiments.push_back(experiment);
  return data;
}

/// Excess over noise of a model whose piston is off by `error`.
double excess(double stays, double declared, double error) {
  return excess_over_noise(standing_piston(stays, declared), {{std::vector<double>(kRows, error)}}, 0);
}

}  // namespace

TEST_GROUP(Goodness){};

// A mean square of n rows with a memory of a is told to sqrt(2 (1 + a^2) / (1 - a^2) / n): 1 % of white noise, 2.1 % of
// noise with a memory of 0.8, and the third differences tell theirs to 2 %. Three standard deviations of excess^2.
TEST(Goodness, AModelThatLeavesWhiteNoiseLeavesNothingBesideItWhateverLittleWasDeclared) {
  CHECK_TRUE(excess(0.0, 0.0, 0.0) < std::sqrt(0.07));
  CHECK_TRUE(excess(0.0, 1.0, 0.0) < std::sqrt(0.07));
  CHECK_TRUE(excess(0.0, 0.1, 0.0) < std::sqrt(0.07));
}

TEST(Goodness, ColouredNoiseIsNoErrorOfTheModelWhereItsSizeIsDeclared) {
  CHECK_TRUE(excess(0.8, 1.0, 0.0) < std::sqrt(0.09));
  // Undeclared, all that is slower than the third differences counts: they see (1 - a)^3 of such noise, or little more.
  CHECK_TRUE(excess(0.8, 0.0, 0.0) > 1.0);
}

// An error e leaves e^2 beside the noise, the floor's three deviations of it and twice e times the mean of the noise, which
// is told to sqrt((1 + a) / (1 - a) / n): 0.1 of 2 together, and 0.14 with a memory of 0.8.
TEST(Goodness, AnErrorBeyondTheNoiseCountsInUnitsOfIt) {
  DOUBLES_EQUAL(2.0, excess(0.0, 1.0, 2.0), 0.1);
  DOUBLES_EQUAL(2.0, excess(0.0, 0.0, 2.0), 0.1);
  DOUBLES_EQUAL(2.0, excess(0.8, 1.0, 2.0), 0.14);
}
