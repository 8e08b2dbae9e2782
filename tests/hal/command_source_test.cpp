// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/command_source.hpp"

#include <CppUTest/TestHarness.h>

using hotfire::hal::sim::CommandSource;

TEST_GROUP(CommandSource){};

TEST(CommandSource, StepsHoldEachLevelForAQuarterOfThePeriod) {
  const CommandSource source{CommandSource::Shape::steps, 0.02, 0.5};
  DOUBLES_EQUAL(0.02, source.at(0.0), 0.0);
  DOUBLES_EQUAL(0.02, source.at(0.499), 0.0);
  DOUBLES_EQUAL(0.0, source.at(0.5), 0.0);
  DOUBLES_EQUAL(-0.02, source.at(1.25), 0.0);
  DOUBLES_EQUAL(0.0, source.at(1.5), 0.0);
  DOUBLES_EQUAL(0.02, source.at(2.0), 0.0);
}

TEST(CommandSource, SineStartsAtZeroAndReachesTheAmplitudeAtAQuarterOfThePeriod) {
  const CommandSource source{CommandSource::Shape::sine, 0.01, 2.0};
  DOUBLES_EQUAL(0.0, source.at(0.0), 0.0);
  DOUBLES_EQUAL(0.01, source.at(0.125), 1e-15);
  DOUBLES_EQUAL(-0.01, source.at(0.375), 1e-15);
}

TEST(CommandSource, RestIsZeroAtAnyTime) {
  const CommandSource source{CommandSource::Shape::rest, 5.0, 2.0};
  DOUBLES_EQUAL(0.0, source.at(0.1), 0.0);
}
