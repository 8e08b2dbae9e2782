// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/clock.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <vector>

#include "model/direct.hpp"
#include "model/simplex.hpp"

namespace hotfire::test {
namespace {

constexpr double kStep = 5e-4;
constexpr double kManySteps = 1e8;  ///< 50,000 s: 13.9 hours of half a millisecond

using Disturbed = model::EffectList<model::UnlistedSignal<model::Site::command>, model::UnlistedRipple>;
using Plant = model::Simplex<float, Disturbed>;

/// A command with a sine of 2 Hz added and an engine reading with mains hum: both have whole numbers of cycles in 50,000 s.
Plant::Parameters disturbed() {
  Plant::Parameters parameters;
  auto& command = std::get<0>(parameters.effects.values);
  command.option = 2;
  command.frequency = 2.0F;
  command.amplitude = 0.01F;
  auto& ripple = std::get<1>(parameters.effects.values);
  ripple.option = 1;
  ripple.frequency = 50.0F;
  ripple.angle = 0.005F;
  parameters.effects.active = {true, true};
  return parameters;
}

/// Two seconds of the engine's reading from a clock on.
std::vector<float> engine_from(double steps) {
  const Plant plant(disturbed(), kStep);
  Plant::State state = plant.steady(0.0F);
  state.clock.steps = steps;
  std::vector<float> readings;
  for (int i = 0; i < 4000; ++i) {
    plant.step(state, 0.0F);
    readings.push_back(Plant::measured(state)[1]);
  }
  return readings;
}

double rms_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) {
    sum += static_cast<double>(value) * static_cast<double>(value);
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

TEST_GROUP(SmallTargetClock){};

TEST(SmallTargetClock, a_float_plant_that_has_stepped_a_hundred_million_times_has_the_time_to_a_nanosecond) {
  using Mass = model::Direct<float, model::EffectList<>>;
  Mass::Parameters parameters;
  parameters.mass = {1.0F, 5.0F, 100.0F};
  const Mass plant(parameters, kStep);
  Mass::State state = plant.at_rest(0.0F);
  state.clock.start = 3.0;
  for (int i = 0; i < 100'000'000; ++i) {
    plant.step(state, 2.0F);
  }
  DOUBLES_EQUAL(3.0 + kManySteps * kStep, state.clock.at(kStep), 1e-9);
  // It stands where its spring holds it. A slow pole of 2.5 1/s over steps of 0.5 ms magnifies a rounding of 6e-8 by 800.
  DOUBLES_EQUAL(0.02, static_cast<double>(Mass::measured(state)[0]), 0.02 * 5e-5);
}

TEST(SmallTargetClock, a_term_of_time_acts_on_a_float_plant_after_a_hundred_million_steps_as_it_does_at_the_start) {
  const std::vector<float> early = engine_from(0.0);
  const std::vector<float> late = engine_from(kManySteps);
  std::vector<float> difference;
  for (std::size_t i = 0; i < early.size(); ++i) {
    difference.push_back(late[i] - early[i]);
  }
  // The phase 2 pi f t, of 1.6e7 rad after 50,000 s, rounds to 2e-9 rad in double. In float it rounds to 1 rad.
  CHECK_TRUE(rms_of(difference) < 1e-6 * rms_of(early));
  // The sines are there: an amplitude a has an rms of a / sqrt 2, and the servo passes 2 Hz.
  CHECK_TRUE(rms_of(early) > 0.5 * std::hypot(0.01, 0.005));
}

}  // namespace hotfire::test
