#include "model/step_size.hpp"

#include <CppUTest/TestHarness.h>

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
