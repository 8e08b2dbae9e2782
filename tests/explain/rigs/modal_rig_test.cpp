// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <string>

#include "tests/explain/rigs/jointed_structure.hpp"
#include "tools/explain/explain.hpp"

namespace hotfire::test {
namespace {

constexpr double kAccelerationNoise = 0.01;  // m/s^2; the places move with some 1 m/s^2

/// One effect is named, and no channel keeps more than so many times its noise on held-out rows.
void check_joint_named(const char* name, const Record& record, double most = 1.15) {
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared_structure(), {record}, options);
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL(name, found.result.effects.front().name.c_str());
  for (const auto& channel : found.result.channels) {
    CHECK_TRUE(channel.explained.rms > 0.85 * kAccelerationNoise);
    CHECK_TRUE(channel.explained.rms < most * kAccelerationNoise);
  }
}

}  // namespace

TEST_GROUP(ExplainModal){};
TEST_GROUP(ExplainModalAtLength){};

TEST(ExplainModal, StiffeningOfAJointIsNamedFromAccelerationsAtThreePlaces) {
  check_joint_named("cubic_stiffness",
                    jointed_structure([](double x, double) { return 3e7 * x * x * x; }, kAccelerationNoise));
}

TEST(ExplainModalAtLength, ClearanceOfAJointIsNamed) {
  check_joint_named("elastic_stop", jointed_structure(
                                        [](double x, double) {
                                          return x > 2e-3 ? 8e3 * (x - 2e-3) : x < -1.5e-3 ? 8e3 * (x + 1.5e-3) : 0.0;
                                        },
                                        kAccelerationNoise));
}

// The friction of the simulator is not quite dry: it has its level at a tenth of a millimetre a second.
TEST(ExplainModalAtLength, FrictionOfAJointIsNamed) {
  check_joint_named("sliding_friction",
                    jointed_structure([](double, double v) { return 4.0 * std::tanh(v / 1e-4); }, kAccelerationNoise), 1.4);
}

}  // namespace hotfire::test
