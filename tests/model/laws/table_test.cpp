// SPDX-License-Identifier: Apache-2.0
#include "model/numerics/table.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>

namespace {

using hotfire::model::curve_value;

constexpr std::array kAt{-2.0, -0.5, 0.0, 3.0};
constexpr std::array kValues{1.0, -1.0, 4.0, 2.0};

double curve(double at, std::size_t points = kAt.size()) { return curve_value<double>(kAt, kValues, points, at); }

}  // namespace

TEST_GROUP(Curve){};

TEST(Curve, AtEachPointItHasTheValueOfThePoint) {
  for (std::size_t k = 0; k < kAt.size(); ++k) {
    DOUBLES_EQUAL(kValues[k], curve(kAt[k]), 0.0);
  }
}

TEST(Curve, BetweenTwoPointsItIsLinear) {
  for (std::size_t k = 1; k < kAt.size(); ++k) {
    for (const double share : {0.01, 0.25, 0.5, 0.99}) {
      const double expected = (1.0 - share) * kValues[k - 1] + share * kValues[k];
      DOUBLES_EQUAL(expected, curve((1.0 - share) * kAt[k - 1] + share * kAt[k]), 1e-14);
    }
  }
}

TEST(Curve, BeyondItsPointsItKeepsTheValueOfTheEnd) {
  for (const double beyond : {1e-9, 1.0, 1e12, HUGE_VAL}) {
    DOUBLES_EQUAL(kValues.front(), curve(kAt.front() - beyond), 0.0);
    DOUBLES_EQUAL(kValues.back(), curve(kAt.back() + beyond), 0.0);
  }
}

TEST(Curve, OfFewerPointsItEndsAtTheLastOfThem) {
  DOUBLES_EQUAL(4.0, curve(2.0, 3), 0.0);
  DOUBLES_EQUAL(-1.0, curve(2.0, 2), 0.0);
  DOUBLES_EQUAL(1.0, curve(2.0, 1), 0.0);
  DOUBLES_EQUAL(0.0, curve(2.0, 0), 0.0);
}
