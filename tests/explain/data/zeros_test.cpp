// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/zeros.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

#include "tools/explain/fit/evaluator.hpp"
#include "tools/explain/terms/candidates.hpp"

using namespace hotfire::explain;

namespace {

constexpr double kZerosNoise = 8e-6;
constexpr double kDeviation = 1e-3;
constexpr std::size_t kRows = 600;

/// One record of the reference axis; the channels have a zero of deviation `deviation`.
Dataset moving_axis(double deviation) {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, true, false};
  data.noise = {kZerosNoise, 6e-5, 1.0};
  data.noise_source.assign(3, NoiseSource::declared);
  Experiment experiment;
  experiment.name = "smooth";
  experiment.period = 2e-3;
  for (std::size_t i = 0; i < kRows; ++i) {
    experiment.input.push_back(0.01 * std::sin(0.02 * static_cast<double>(i)));
  }
  experiment.noise = data.noise;
  experiment.zero_deviation.assign(3, deviation);
  experiment.measured = {std::vector<double>(kRows, 0.0), std::vector<double>(kRows, 0.0), {}};
  experiment.fitted = {{0, 200}, {300, kRows}};
  experiment.held_out = {{200, 300}};
  data.experiments.push_back(experiment);
  return data;
}

/// What the axis does, with noise, read `zero` off.
void measure(Dataset& data, double zero) {
  Dataset plain = data;
  plain.experiments.front().zero_deviation.assign(3, 0.0);
  Prediction truth;
  CHECK_TRUE(Evaluator(plain, Resolution::fine).predict({}, {}, {}, 1, truth));
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < kRows; ++i) {
      data.experiments.front().measured[c][i] = truth[0][c][i] + zero + data.noise[c] * normal(generator);
    }
  }
}

}  // namespace

TEST_GROUP(Zeros){};

// The zero is a mean over the rows that a fit sees: told to noise / sqrt(500), here four of it.
TEST(Zeros, AChannelThatReadsOffIsMetByItsZeroOnHeldOutRowsToo) {
  Dataset data = moving_axis(kDeviation);
  measure(data, 5e-4);
  Prediction prediction;
  Zeros zeros;
  CHECK_TRUE(Evaluator(data, Resolution::fine).predict({}, {}, {}, 1, prediction, zeros));
  DOUBLES_EQUAL(5e-4, zeros[0][0], 4.0 * kZerosNoise / std::sqrt(500.0));
  const Experiment& experiment = data.experiments.front();
  double square = 0.0;
  for (std::size_t i = 200; i < 300; ++i) {
    square += std::pow(experiment.measured[0][i] - prediction[0][0][i], 2);
  }
  DOUBLES_EQUAL(kZerosNoise, std::sqrt(square / 100.0), 0.3 * kZerosNoise);
}

/// Whitened by its prior, a zero of z deviations costs z^2 beside what the noise costs (completed square), however many rows
/// there are.
TEST(Zeros, AZeroCostsItsPriorAndNoMore) {
  Dataset none = moving_axis(kDeviation);
  Dataset off = moving_axis(kDeviation);
  measure(none, 0.0);
  measure(off, 2.0 * kDeviation);
  const auto cost = [](const Dataset& data) {
    const Evaluator evaluator(data, Resolution::fine);
    Prediction prediction;
    CHECK_TRUE(evaluator.predict({}, {}, {}, 1, prediction));
    return evaluator.squares_by_channel(evaluator.residuals(prediction))[0];
  };
  DOUBLES_EQUAL(4.0, cost(off) - cost(none), 0.05);
}

/// The derivatives are those of the residuals: differences over a small step agree.
TEST(Zeros, DerivativesAreOfTheWhitenedResiduals) {
  Dataset data = moving_axis(kDeviation);
  measure(data, 5e-4);
  const Evaluator evaluator(data, Resolution::fine);
  const hotfire::SimplexParameters base;
  const auto free = declared_parameters(base, {{"servovalve.position_gain", 0.03}});
  const std::vector<std::size_t> all{0};
  const std::vector<double> at{0.0};
  Eigen::MatrixXd jacobian;
  CHECK_TRUE(evaluator.differentiate(base, free, at, all, 1, jacobian));
  const auto residuals_at = [&](double u) {
    Prediction prediction;
    CHECK_TRUE(evaluator.predict(base, free, std::vector<double>{u}, 1, prediction));
    return evaluator.residuals(prediction);
  };
  constexpr double kStep = 1e-3;
  const Eigen::VectorXd difference = (residuals_at(kStep) - residuals_at(-kStep)) / (2.0 * kStep);
  CHECK((difference - jacobian.col(0)).norm() < 1e-4 * jacobian.norm());
}

/// A constant of the plant is told by what it does to the motion, not by where a sensor reads zero: with free zeros a shift
/// of the command leaves no derivative but what the prior holds, sqrt(n) noise / deviation of it.
TEST(Zeros, AShiftThatAZeroCanBeIsNotIdentified) {
  Dataset free_zero = moving_axis(kDeviation);
  Dataset known_zero = moving_axis(0.0);
  Eigen::VectorXd shift[2];
  int i = 0;
  for (Dataset* data : {&free_zero, &known_zero}) {
    measure(*data, 0.0);
    const Evaluator evaluator(*data, Resolution::fine);
    Prediction prediction;
    CHECK_TRUE(evaluator.predict({}, {}, {}, 1, prediction));
    const Eigen::VectorXd before = evaluator.residuals(prediction);
    Dataset moved = *data;
    for (double& value : moved.experiments.front().measured[0]) {
      value -= kDeviation;
    }
    const Evaluator other(moved, Resolution::fine);
    CHECK_TRUE(other.predict({}, {}, {}, 1, prediction));
    shift[i++] = other.residuals(prediction) - before;
  }
  const double expected = 1.0 / std::sqrt(1.0 + 500.0 * std::pow(kDeviation / kZerosNoise, 2));
  DOUBLES_EQUAL(expected, shift[0].norm() / shift[1].norm(), 0.01 * expected);
}
