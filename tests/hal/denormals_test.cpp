// SPDX-License-Identifier: Apache-2.0
#include "hal/arithmetic/denormals.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

namespace {

/// Halves the smallest normal number out of the compiler's sight.
double half_of_smallest() {
  volatile double smallest = std::numeric_limits<double>::min();
  volatile double half = 0.5;
  return smallest * half;
}

}  // namespace

TEST_GROUP(FlushDenormals){};

#if defined(__SSE2__) || defined(__aarch64__)
TEST(FlushDenormals, DenormalResultIsZeroWhileItLivesAndBackAfterwards) {
  CHECK(half_of_smallest() > 0.0);
  {
    const hotfire::hal::FlushDenormals flush;
    DOUBLES_EQUAL(0.0, half_of_smallest(), 0.0);
  }
  CHECK(half_of_smallest() > 0.0);
}
#endif
