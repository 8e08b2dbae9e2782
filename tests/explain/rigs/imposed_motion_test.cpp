// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <string>

#include "tests/explain/rigs/moved_damper.hpp"
#include "tests/support/refusal.hpp"
#include "tools/explain/explain.hpp"
#include "tools/simulate/path.hpp"

namespace hotfire::test {
namespace {

constexpr double kForceNoise = 1.0;  // N; the damper's own force is some 100 N

/// One effect is named, and of the held-out rows at most so many times the noise is left. A force that sets in at once is
/// half a step early or late: it is wrong by half of its jump in an eighth of the rows beside one.
void check_named_alone(const char* name, const Record& record, double most = 1.1) {
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared_damper(), {record}, options);
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL(name, found.result.effects.front().name.c_str());
  const auto& force = found.result.channels.at(0);
  CHECK_TRUE(force.explained.rms > 0.9 * kForceNoise);
  CHECK_TRUE(force.explained.rms < most * kForceNoise);
  CHECK_TRUE(force.explained.rms < 0.2 * force.calibrated.rms);
}

double nothing(double, double) { return 0.0; }

}  // namespace

TEST_GROUP(ExplainImposedMotion){};
TEST_GROUP(ExplainImposedMotionAtLength){};

// Lagrange's polynomial through six rows is off by 5 / 1024 (w T)^6 half-way between the middle ones, and by some five times
// that in the outermost interval: at w T = 0.377 by 1.4e-5 and 7e-5.
TEST(ExplainImposedMotion, PathIsSmoothBetweenItsRowsAndGoesOnBeyondItsEnds) {
  constexpr int steps = 8;
  constexpr double turn = 0.377;
  std::vector<double> rows;
  for (int row = 0; row < 200; ++row) {
    rows.push_back(std::sin(turn * row + 0.3));
  }
  const Path path(rows, steps);
  const std::ptrdiff_t last = 199 * steps;
  for (std::ptrdiff_t step = -1; step <= last + 1; ++step) {
    const bool is_near_end = step < 3 * steps || step > last - 3 * steps;
    DOUBLES_EQUAL(std::sin(turn * static_cast<double>(step) / steps + 0.3), path.at(step), is_near_end ? 1e-4 : 1.5e-5);
  }
}

TEST(ExplainImposedMotion, NothingIsFoundWhereNothingIsMissing) {
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared_damper(), {moved_damper(nothing, 0.0, kForceNoise)}, options);
  CHECK_EQUAL(0U, found.result.effects.size());
  DOUBLES_EQUAL(kForceNoise, found.result.channels.at(0).explained.rms, 0.1 * kForceNoise);
}

TEST(ExplainImposedMotion, FreePlayOfADamperIsNamed) {
  check_named_alone("free_play", moved_damper(nothing, 0.002, kForceNoise), 8.0);
}

TEST(ExplainImposedMotionAtLength, DragThatGrowsWithTheSquareOfTheSpeedIsNamed) {
  check_named_alone("quadratic_damping",
                    moved_damper([](double, double v) { return 900.0 * v * std::abs(v); }, 0.0, kForceNoise));
}

TEST(ExplainImposedMotionAtLength, FrictionThatDiffersByDirectionIsNamed) {
  check_named_alone("sliding_friction",
                    moved_damper([](double, double v) { return v > 0.0 ? 30.0 : -18.0; }, 0.0, kForceNoise), 1.3);
}

TEST(ExplainImposedMotionAtLength, StopBeyondAClearanceIsNamed) {
  check_named_alone("elastic_stop", moved_damper(
                                        [](double x, double) {
                                          return x > 0.02 ? 2e4 * (x - 0.02) : x < -0.015 ? 2e4 * (x + 0.015) : 0.0;
                                        },
                                        0.0, kForceNoise));
}

TEST(ExplainImposedMotion, RecordWithoutTheForceIsRefused) {
  Record record = moved_damper(nothing, 0.0, kForceNoise);
  record.channels.pop_back();
  explain::ExplainOptions options;
  STRCMP_CONTAINS("force", refusal([&] { explain::explain(declared_damper(), {record}, options); }).c_str());
}

}  // namespace hotfire::test
