// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include "hal/linux/posix_clock.hpp"
#include "hal/sim/manual_clock.hpp"

using hotfire::hal::PosixClock;
using hotfire::hal::sim::ManualClock;

TEST_GROUP(Clock){};

TEST(Clock, MonotonicClockNeverReturnsBeforeTheTimeAskedFor) {
  PosixClock clock;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t wanted = clock.now_ns() + 50'000;
    clock.sleep_until_ns(wanted);
    CHECK(clock.now_ns() >= wanted);
  }
}

TEST(Clock, SleepUntilAPastTimeDoesNotMoveTheManualClock) {
  ManualClock clock;
  clock.advance_ns(1000);
  clock.sleep_until_ns(400);
  LONGS_EQUAL(1000, clock.now_ns());
}

TEST(Clock, InjectedLatenessAppliesToOneSleepOnly) {
  ManualClock clock;
  clock.delay_next_wake_up_ns(30);
  clock.sleep_until_ns(100);
  LONGS_EQUAL(130, clock.now_ns());
  clock.sleep_until_ns(200);
  LONGS_EQUAL(200, clock.now_ns());
  UNSIGNED_LONGS_EQUAL(2, clock.sleeps());
}
