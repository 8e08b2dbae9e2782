// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/black_box.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/explain/fit/goodness.hpp"

using namespace hotfire::explain;

namespace {

constexpr double kBlackBoxPeriod = 2e-3;
constexpr std::size_t kBlackBoxRows = 8000;
constexpr double kBlackBoxNoise = 1e-3;
constexpr std::size_t kLate = 7;

/// Two records of a lightly damped second-order lag of 5 Hz that answers `kLate` rows late, each with a zero of its own.
Dataset lagging() {
  Dataset data;
  data.channels = {"piston"};
  data.used = {true};
  data.noise = {kBlackBoxNoise};
  data.noise_source = {NoiseSource::declared};
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int e = 0; e < 2; ++e) {
    Experiment experiment;
    experiment.name = "lagging";
    experiment.period = kBlackBoxPeriod;
    for (std::size_t i = 0; i < kBlackBoxRows; ++i) {
      const double time = static_cast<double>(i) * kBlackBoxPeriod;
      experiment.input.push_back(std::sin(2.0 * time * (1.0 + time)) + (i / 1000 % 2 == 0 ? 0.3 : -0.2));
    }
    const double natural = 2.0 * 3.141592653589793 * 5.0;
    double x = experiment.input.front();
    double v = 0.0;
    std::vector<double> measured;
    constexpr int kSteps = 50;
    for (std::size_t i = 0; i < kBlackBoxRows; ++i) {
      measured.push_back(x + (e == 0 ? 0.5 : -0.2) + kBlackBoxNoise * normal(generator));
      const double command = experiment.input[i >= kLate ? i - kLate : 0];
      for (int k = 0; k < kSteps; ++k) {
        v += kBlackBoxPeriod / kSteps * natural * (natural * (command - x) - 0.4 * v);
        x += kBlackBoxPeriod / kSteps * v;
      }
    }
    experiment.measured = {std::move(measured)};
    experiment.noise = data.noise;
    experiment.zero_deviation = {1.0};
    experiment.fitted = {{0, 2000}, {3000, kBlackBoxRows}};
    experiment.held_out = {{2000, 3000}};
    data.experiments.push_back(std::move(experiment));
  }
  return data;
}

}  // namespace

TEST_GROUP(BlackBox){};

// The held lag is a difference equation of second order exactly, one row later than its delay: what is left is noise, known
// to a fiftieth by 2000 rows, with a tenth for an order whose worth is a fiftieth.
TEST(BlackBox, ALinearRigIsMetDownToItsNoiseWithItsOrderAndItsDelay) {
  const Dataset data = lagging();
  const BlackBox box = black_box(data);
  CHECK(box.channels[0].has_value());
  LONGS_EQUAL(2, box.channels[0]->order());
  LONGS_EQUAL(kLate + 1, box.channels[0]->delay);
  const Goodness reached = goodness(data, simulated(box, data));
  CHECK(reached.held_out[0].rms < 1.1 * kBlackBoxNoise);
  CHECK(reached.held_out[0].rms > 0.9 * kBlackBoxNoise);
  const BlackBox on_threads = black_box(data, 3);
  CHECK(box.channels[0]->a == on_threads.channels[0]->a);
  CHECK(box.channels[0]->b == on_threads.channels[0]->b);
}

// Fitted to the next row instead, the same equation with this noise has poles that are far too fast.
TEST(BlackBox, AnOrderThatIsNotThereIsNotTaken) {
  Dataset data = lagging();
  for (Experiment& experiment : data.experiments) {
    for (std::size_t i = 0; i < kBlackBoxRows; ++i) {
      experiment.measured[0][i] = 2.0 * experiment.input[i >= 3 ? i - 3 : 0];
    }
  }
  const BlackBox box = black_box(data);
  LONGS_EQUAL(1, box.channels[0]->order());
  LONGS_EQUAL(3, box.channels[0]->delay);
}

// Three modes are of order six. With an order of four, that of two modes, the third one is left. Poles beyond the six take
// up what the passes leave of them.
TEST(BlackBox, AStructureOfThreeModesIsMetWithAHigherOrderThanFour) {
  constexpr std::array kNatural{2.0 * std::numbers::pi * 4.0, 2.0 * std::numbers::pi * 9.0, 2.0 * std::numbers::pi * 15.0};
  Dataset data = lagging();
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (Experiment& experiment : data.experiments) {
    std::array<double, 3> x{};
    std::array<double, 3> v{};
    for (std::size_t i = 0; i < kBlackBoxRows; ++i) {
      experiment.measured[0][i] = x[0] + x[1] + x[2] + kBlackBoxNoise * normal(generator);
      experiment.input[i] = i > 0 ? normal(generator) : 0.0;  // at rest under the first input
      constexpr int kSteps = 50;
      for (int k = 0; k < kSteps; ++k) {
        for (std::size_t mode = 0; mode < kNatural.size(); ++mode) {
          v[mode] += kBlackBoxPeriod / kSteps *
                     (kNatural[mode] * (experiment.input[i] - kNatural[mode] * x[mode]) - 0.1 * kNatural[mode] * v[mode]);
          x[mode] += kBlackBoxPeriod / kSteps * v[mode];
        }
      }
    }
  }
  const BlackBox box = black_box(data);
  CHECK(box.channels[0].has_value());
  CHECK(box.channels[0]->order() >= 6);
  const Goodness reached = goodness(data, simulated(box, data));
  CHECK(reached.held_out[0].rms < 1.1 * kBlackBoxNoise);
  CHECK(reached.held_out[0].rms > 0.9 * kBlackBoxNoise);
}

TEST(BlackBox, RecordsOfSeveralPeriodsHaveNone) {
  Dataset data = lagging();
  data.experiments[1].period = 3e-3;
  CHECK(!black_box(data).is_there());
}
