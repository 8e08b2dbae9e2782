// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/delay_line.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

constexpr double kStep = 1e-3;

double parabola(double time) { return 2.0 + 3.0 * time - 40.0 * time * time; }

/// What a line reads 50 steps after a parabola began to pass through it.
double reading(double delay) {
  model::DelayLine<double, 64> line;
  line.fill(parabola(-kStep));
  double last = 0.0;
  for (int n = 0; n <= 50; ++n) {
    last = line.pass(parabola(n * kStep), delay, kStep);
  }
  return last;
}

}  // namespace

TEST_GROUP(DelayLine){};

TEST(DelayLine, ReadsAParabolaAheadOfItsTimeWhereTheDelayIsNegative) {
  for (const double early : {0.3e-3, 1e-3, 7.7e-3}) {
    DOUBLES_EQUAL(parabola(50 * kStep + early), reading(-early), 1e-12);
  }
}

TEST(DelayLine, ReadsWhatWasBetweenTwoStepsOnTheLineBetweenThem) {
  // On a chord of a parabola, wrong by at most its bend over a step, |x''| h^2 / 8.
  for (const double late : {0.0, 0.3e-3, 1e-3, 7.7e-3}) {
    DOUBLES_EQUAL(parabola(50 * kStep - late), reading(late), 80.0 * kStep * kStep / 8.0 + 1e-12);
  }
}

}  // namespace hotfire::test
