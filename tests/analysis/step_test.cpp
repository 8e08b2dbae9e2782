// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/analysis/step_response.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::analysis {
namespace {

constexpr double kStepPeriod = 1e-3;

/// Steps at 1 s to 2 and at 3 s back to 0, until 5 s.
std::vector<double> command() {
  std::vector<double> values(1000, 0.0);
  values.insert(values.end(), 2000, 2.0);
  values.insert(values.end(), 2000, 0.0);
  return values;
}

}  // namespace

TEST_GROUP(Steps){};

// Overshoot e^(-pi zeta / sqrt(1 - zeta^2)) of a second-order system, zeta 0.5 at 20 rad/s: 16.3 %, and the known rise.
TEST(Steps, OfASecondOrderSystemHaveItsOvershootAndRise) {
  const std::vector<double> commands = command();
  std::vector<double> channel;
  double position = 0.0;
  double speed = 0.0;
  for (const double value : commands) {
    channel.push_back(position);
    for (int k = 0; k < 100; ++k) {
      speed += 0.01 * kStepPeriod * (400.0 * (value - position) - 20.0 * speed);
      position += 0.01 * kStepPeriod * speed;
    }
  }
  const std::vector<StepResponse> steps = step_responses(commands, channel, kStepPeriod, 1.0);
  LONGS_EQUAL(2, steps.size());
  DOUBLES_EQUAL(2.0, steps[0].change, 1e-3);
  DOUBLES_EQUAL(-2.0, steps[1].change, 1e-3);
  for (const StepResponse& step : steps) {
    DOUBLES_EQUAL(0.163, step.overshoot, 0.002);
    DOUBLES_EQUAL(1.64 / 20.0, step.rise_time, 0.003);
    // Its envelope, e^(-10 t), is under 5 % after 0.3 s; it is inside for good from 0.26 s.
    DOUBLES_EQUAL(0.264, step.settling_time, 0.01);
    CHECK_TRUE(step.hesitation < 0.02);
  }
}

TEST(Steps, ThatWaitAndStallSayHowLong) {
  const std::vector<double> commands = command();
  std::vector<double> channel(commands.size(), 0.0);
  for (std::size_t k = 1000; k < channel.size(); ++k) {
    const double time = 1e-3 * static_cast<double>(k - 1000);
    // Waits 0.05 s, rises to 60 % in 0.05 s, stalls 0.2 s, rises on.
    const double share = time < 0.05 ? 0.0 : time < 0.1 ? 12.0 * (time - 0.05) : time < 0.3 ? 0.6 : 0.6 + 4.0 * (time - 0.3);
    channel[k] = 2.0 * std::min(1.0, share);
  }
  const StepResponse step = step_responses(commands, channel, kStepPeriod, 1.0).front();
  DOUBLES_EQUAL(0.2, step.hesitation, 0.005);
  DOUBLES_EQUAL(0.0, step.overshoot, 1e-9);
}

TEST(Steps, ThatAreNotHeldAreNone) {
  std::vector<double> ramp(2000);
  for (std::size_t k = 0; k < ramp.size(); ++k) {
    ramp[k] = static_cast<double>(k);
  }
  LONGS_EQUAL(0, step_responses(ramp, ramp, kStepPeriod, 0.5).size());
}

TEST(Steps, ThatDoNotSettleHaveNoSettlingTime) {
  const std::vector<double> commands = command();
  std::vector<double> channel = commands;
  for (std::size_t k = 1000; k < channel.size(); ++k) {
    channel[k] += 0.5 * std::sin(30.0 * static_cast<double>(k) * kStepPeriod);
  }
  CHECK_TRUE(std::isnan(step_responses(commands, channel, kStepPeriod, 1.0).front().settling_time));
}

}  // namespace hotfire::analysis
