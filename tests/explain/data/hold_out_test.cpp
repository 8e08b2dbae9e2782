// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/hold_out.hpp"

#include <cmath>
#include <numbers>

#include <CppUTest/TestHarness.h>

namespace {

using hotfire::explain::Block;
using hotfire::explain::Experiment;

constexpr double kHoldOutPeriod = 2e-3;
constexpr std::size_t kHoldOutRows = 32 * 500;  // 32 s: eight blocks of four seconds
constexpr std::size_t kBlock = kHoldOutRows / 8;

/// A sine of amplitude 1, and of `amplitude` within one block.
Experiment sines(std::size_t block, double amplitude) {
  Experiment experiment;
  experiment.period = kHoldOutPeriod;
  experiment.measured.emplace_back();
  for (std::size_t row = 0; row < kHoldOutRows; ++row) {
    const double size = row / kBlock == block ? amplitude : 1.0;
    experiment.input.push_back(size * std::sin(2.0 * std::numbers::pi * static_cast<double>(row) * kHoldOutPeriod));
    experiment.measured.front().push_back(experiment.input.back());
  }
  return experiment;
}

bool is_held_out(const Experiment& experiment, std::size_t block) {
  for (const Block& held : experiment.held_out) {
    if (held.first <= block * kBlock && held.last >= (block + 1) * kBlock) {
      return true;
    }
  }
  return false;
}

std::size_t rows_held_out(const Experiment& experiment) {
  std::size_t rows = 0;
  for (const Block& held : experiment.held_out) {
    rows += held.last - held.first;
  }
  return rows;
}

}  // namespace

TEST_GROUP(HoldOut){};

TEST(HoldOut, TheThirdOfEachFourBlocksIsHeldOutWhereAllMoveAlike) {
  std::vector<Experiment> experiments{sines(0, 1.0)};
  hotfire::explain::hold_out(experiments);
  for (std::size_t block = 0; block < 8; ++block) {
    CHECK_EQUAL(block == 2 || block == 6, is_held_out(experiments[0], block));
  }
}

TEST(HoldOut, ABlockThatAloneReachesTheLargestExcursionIsFittedAndAnotherIsHeldOutInItsPlace) {
  for (std::size_t largest = 0; largest < 8; ++largest) {
    std::vector<Experiment> experiments{sines(largest, 3.0)};
    hotfire::explain::hold_out(experiments);
    CHECK(!is_held_out(experiments[0], largest));
    CHECK(!is_held_out(experiments[0], 0));
    LONGS_EQUAL(2 * kBlock, rows_held_out(experiments[0]));
  }
}

TEST(HoldOut, ALargestExcursionThatAnotherRecordReachesTooMayBeHeldOut) {
  std::vector<Experiment> experiments{sines(2, 3.0), sines(4, 3.0)};
  hotfire::explain::hold_out(experiments);
  CHECK(is_held_out(experiments[0], 2));
  CHECK(!is_held_out(experiments[1], 4));
}

TEST(HoldOut, AnExtremeInExcludedRowsDoesNotCount) {
  std::vector<Experiment> experiments{sines(2, 3.0)};
  experiments[0].excluded = {{2 * kBlock, 3 * kBlock}};
  hotfire::explain::hold_out(experiments);
  CHECK(is_held_out(experiments[0], 2));
}
