// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/histogram.hpp"

#include <CppUTest/TestHarness.h>

#include <memory>

using hotfire::firmware::Histogram;

TEST_GROUP(Histogram) { std::unique_ptr<Histogram> histogram = std::make_unique<Histogram>(1000); };

TEST(Histogram, EmptyHistogramHasZeroForEveryFigure) {
  LONGS_EQUAL(0, histogram->least_ns());
  LONGS_EQUAL(0, histogram->greatest_ns());
  LONGS_EQUAL(0, histogram->quantile_ns(0.5));
  DOUBLES_EQUAL(0.0, histogram->mean_ns(), 0.0);
}

TEST(Histogram, LeastGreatestAndMeanAreExact) {
  for (const std::int64_t duration : {1500, 2500, 20'000'000}) {
    histogram->add(duration);
  }
  LONGS_EQUAL(1500, histogram->least_ns());
  LONGS_EQUAL(20'000'000, histogram->greatest_ns());
  DOUBLES_EQUAL(20'004'000.0 / 3.0, histogram->mean_ns(), 1e-6);
}

TEST(Histogram, WhatLiesBeyondTheLastBinIsCountedAsOverflow) {
  histogram->add(static_cast<std::int64_t>(Histogram::kBins) * 1000 - 1);
  UNSIGNED_LONGS_EQUAL(0, histogram->overflow());
  histogram->add(static_cast<std::int64_t>(Histogram::kBins) * 1000);
  UNSIGNED_LONGS_EQUAL(1, histogram->overflow());
  UNSIGNED_LONGS_EQUAL(2, histogram->count());
}

TEST(Histogram, QuantileIsNeverBelowTheTrueOneAndAtMostABinAbove) {
  for (std::int64_t i = 1; i <= 100; ++i) {
    histogram->add(i * 1000 + 1);
  }
  LONGS_EQUAL(51'000, histogram->quantile_ns(0.5));
  LONGS_EQUAL(100'000, histogram->quantile_ns(0.99));
  LONGS_EQUAL(100'001, histogram->quantile_ns(1.0));
}

TEST(Histogram, QuantileInTheOverflowIsTheGreatest) {
  histogram->add(50'000'000);
  histogram->add(60'000'000);
  LONGS_EQUAL(60'000'000, histogram->quantile_ns(0.5));
}
