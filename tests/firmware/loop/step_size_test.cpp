// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/step_size.hpp"

#include <CppUTest/TestHarness.h>

#include <numbers>

#include "model/direct.hpp"

using hotfire::model::steps_per_period;

TEST_GROUP(StepSize){};

TEST(StepSize, PeriodUpToTheLongestStepIsOneStep) {
  LONGS_EQUAL(1, steps_per_period(5e-5));
  LONGS_EQUAL(1, steps_per_period(2.5e-4));
  LONGS_EQUAL(1, steps_per_period(5e-4));
}

TEST(StepSize, LongerPeriodIsSplitIntoTheFewestStepsThatAreShortEnough) {
  LONGS_EQUAL(2, steps_per_period(5.01e-4));
  LONGS_EQUAL(2, steps_per_period(1e-3));
  LONGS_EQUAL(4, steps_per_period(2e-3));
  LONGS_EQUAL(20, steps_per_period(1e-2));
}

TEST(StepSize, RoundingOfAMultipleDoesNotAddAStep) {
  LONGS_EQUAL(6, steps_per_period(3 * 1e-3));
  LONGS_EQUAL(6, steps_per_period(0.3 - 0.297));
}

// 2 pi at 100 Hz over a tenth of a radian: 63 steps a cycle, 10 ms long, at least.
TEST(StepSize, MassOnASpringTakesATenthOfARadianOfItsOwnOscillation) {
  using Mass = hotfire::model::Direct<double>;
  Mass::Parameters parameters;
  const double angular = 2.0 * std::numbers::pi * 100.0;
  parameters.mass.inertia = 2.0;
  parameters.mass.stiffness = 2.0 * angular * angular;
  LONGS_EQUAL(63, steps_per_period<Mass>(parameters, 1e-2));
  parameters.mass.stiffness = 0.0;
  LONGS_EQUAL(steps_per_period(1e-2), steps_per_period<Mass>(parameters, 1e-2));
  parameters.mass.stiffness = 1e30;
  LONGS_EQUAL(200, steps_per_period<Mass>(parameters, 1e-3));
}
