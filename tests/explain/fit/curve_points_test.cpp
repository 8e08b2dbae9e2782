// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/curve_points.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

namespace {

using hotfire::explain::curve_points;

constexpr double kReach = 0.05;

/// A stroke of +-kReach run through evenly, and white noise of rms 1 on `curve`.
template <class Curve>
std::vector<double> points_of(std::size_t most, Curve&& curve) {
  std::mt19937_64 generator(1991);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 20000; ++i) {
    x.push_back(kReach * (2.0 * i / 19999.0 - 1.0));
    y.push_back(curve(x.back()) + normal(generator));
  }
  return curve_points(x, y, most);
}

}  // namespace

TEST_GROUP(CurvePoints){};

TEST(CurvePoints, ABumpFarNarrowerThanEvenPointsAreApartGetsThePointsItNeeds) {
  // Even points would be 6.7 mm apart; the bump is 3 mm wide at a third of its height.
  constexpr double kAt = 0.012;
  constexpr double kWidth = 1.5e-3;
  const std::vector<double> points =
      points_of(16, [](double x) { return 20.0 * std::exp(-(x - kAt) * (x - kAt) / (kWidth * kWidth)); });
  const auto near = std::count_if(points.begin(), points.end(), [](double x) { return std::abs(x - kAt) < 3.0 * kWidth; });
  // Its foot on either side and its top.
  CHECK(near >= 3);
  CHECK(std::is_sorted(points.begin(), points.end()));
  CHECK(points.size() <= 16);
  DOUBLES_EQUAL(-kReach, points.front(), 1e-12);
  DOUBLES_EQUAL(kReach, points.back(), 1e-12);
}

TEST(CurvePoints, AStraightLineInNoiseNeedsItsEndsOnly) {
  LONGS_EQUAL(2, points_of(16, [](double x) { return 100.0 * x; }).size());
}

TEST(CurvePoints, AKinkGetsItsPointWhereItIs) {
  const std::vector<double> points = points_of(16, [](double x) { return 500.0 * std::abs(x + 0.02); });
  CHECK(points.size() >= 3);
  // Two places of 0.5 mm.
  CHECK(std::any_of(points.begin(), points.end(), [](double x) { return std::abs(x + 0.02) < 1e-3; }));
}

TEST(CurvePoints, WhatHasNoWidthHasNoPoints) {
  const std::vector<double> same(100, 1.0);
  CHECK(curve_points(same, same, 16).empty());
  CHECK(curve_points({}, {}, 16).empty());
}
