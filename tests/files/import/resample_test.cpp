// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/resample.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/files/expect.hpp"

using hotfire::Resampled;
using hotfire::resampled;
using hotfire::test::expect_message;

namespace {

double sine(double frequency, double time) { return std::sin(2.0 * std::numbers::pi * frequency * time); }

/// Times of a log whose rows come late by up to `jitter` of the interval.
std::vector<double> times_of(std::size_t rows, double interval, double jitter) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> late(0.0, jitter);
  std::vector<double> times;
  for (std::size_t i = 0; i < rows; ++i) {
    times.push_back(interval * (static_cast<double>(i) + (i == 0 || i + 1 == rows ? 0.0 : late(generator))));
  }
  return times;
}

Resampled resampled_sine(double frequency, const std::vector<double>& times, double period) {
  std::vector<double> values;
  for (const double time : times) {
    values.push_back(sine(frequency, time));
  }
  return resampled(times, {values}, {false}, period);
}

/// Largest error about the middle, where the kernel has all of its neighbours.
double error_in_the_middle(const Resampled& result, double frequency, double size) {
  double largest = 0.0;
  const std::vector<double>& values = result.values.front();
  for (std::size_t i = values.size() / 4; i < values.size() * 3 / 4; ++i) {
    const double time = result.start + static_cast<double>(i) * result.period;
    largest = std::max(largest, std::abs(values[i] - size * sine(frequency, time)));
  }
  return largest;
}

std::string refusal_of(const std::vector<double>& times) {
  try {
    resampled(times, {std::vector<double>(times.size(), 0.0)}, {false}, 2e-3);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_GROUP(Resample){};

// A window of 80 dB: a ten-thousandth in the pass band, which ends at 0.41 of the rate, and a thousandth with two such
// ripples.
TEST(Resample, ASineBelowFourTenthsOfTheRateIsReconstructed) {
  const auto times = times_of(2000, 0.1, 0.0);
  CHECK(error_in_the_middle(resampled_sine(4.0, times, 0.02), 4.0, 1.0) < 1e-3);
}

TEST(Resample, WhatTheNewRateCannotHoldIsGoneAndNotFolded) {
  const auto times = times_of(4000, 2e-3, 0.0);
  CHECK(error_in_the_middle(resampled_sine(60.0, times, 0.01), 60.0, 0.0) < 1e-3);
  CHECK(error_in_the_middle(resampled_sine(30.0, times, 0.01), 30.0, 1.0) < 1e-3);
}

// A cubic spline of interval h is off by (2 pi f h)^4 / 384 of a sine: 4e-7 at a fiftieth of the rate, with h the widest
// interval of 1.3 mean ones; taking the rows as even would leave 2 pi f times the jitter, two hundredths.
TEST(Resample, AJitteredLogFollowsItsStampsNotItsRows) {
  const auto times = times_of(4000, 0.01, 0.3);
  const Resampled result = resampled_sine(2.0, times, 0.01);
  CHECK(error_in_the_middle(result, 2.0, 1.0) < 2e-3);
  STRCMP_CONTAINS("spline", result.note.c_str());
}

TEST(Resample, ACommandKeepsItsAreaAndItsSteps) {
  std::vector<double> times;
  std::vector<double> command;
  for (int i = 0; i < 10; ++i) {
    times.push_back(0.01 * i);
    command.push_back(i < 5 ? 1.0 : 3.0);
  }
  const Resampled finer = resampled(times, {command}, {true}, 2e-3);
  DOUBLES_EQUAL(1.0, finer.values[0][24], 1e-12);
  DOUBLES_EQUAL(3.0, finer.values[0][25], 1e-12);
  const Resampled coarser = resampled(times, {command}, {true}, 0.02);
  DOUBLES_EQUAL(2.0, coarser.values[0][2], 1e-12);  // half a period of each
}

TEST(Resample, WhatCannotBePutOnAGridIsRefusedWithItsRow) {
  std::vector<double> times = times_of(20, 0.01, 0.0);
  times[7] = times[6];
  expect_message(refusal_of(times), {"row 8", "above the one before"});
  times = times_of(20, 0.01, 0.0);
  for (std::size_t i = 10; i < times.size(); ++i) {
    times[i] += 0.03;
  }
  expect_message(refusal_of(times), {"row 11", "gap of 0.04 s"});
  expect_message(refusal_of(times_of(20, 0.2, 0.0)), {"0.2 s", "10 Hz"});
}
