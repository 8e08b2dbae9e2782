// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/held_start.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"

using namespace hotfire;

namespace {

/// Steps of falling size from 2 s before the record on, of which the axis without effects forgets the start in 2 s.
explain::Dataset steps_in_motion() {
  Record record = test::record_under(test::declared(), [](double t) {
    const double level = 0.01 - 0.002 * std::floor(t / 4.0);
    return std::fmod(t, 4.0) < 2.0 ? level : -level;
  });
  explain::Dataset data = explain::make_dataset(test::declared(), {record});
  explain::forget_start(data.experiments.front(), 1000);
  return data;
}

/// The declared model with gimbal friction by Dahl's law, in a fit of the declared parameters.
explain::Fitted with_friction() {
  explain::Fitted model = test::about_declared();
  model.base = test::with_effect<model::GimbalFriction>({1.15e4, 9.2e6}, static_cast<int>(model::GimbalFriction::Law::dahl))
                   .parameters;
  return model;
}

}  // namespace

TEST_GROUP(HeldStart){};

TEST(HeldStart, FrictionRemembersAStartOverReversalsAndTheAxisWithoutItForgetsIt) {
  explain::Dataset data = steps_in_motion();
  CHECK_FALSE(explain::forget_held_starts(test::about_declared(), 1, data));
  LONGS_EQUAL(1000, data.experiments.front().first_scored);
  CHECK_TRUE(explain::forget_held_starts(with_friction(), 1, data));
  const std::size_t rows = data.experiments.front().first_scored;
  CHECK(rows > 2000);
  CHECK(rows <= data.experiments.front().rows() / 2);
  CHECK_FALSE(data.experiments.front().held_out.empty());
  for (const explain::Block& block : data.experiments.front().scored()) {
    CHECK(block.first >= rows);
  }
  // A second look takes nothing more out.
  CHECK_FALSE(explain::forget_held_starts(with_friction(), 1, data));
}

TEST(HeldStart, ARecordThatStartsAtRestKeepsItsFirstRows) {
  explain::Dataset data = test::data_of(test::declared());
  CHECK_FALSE(explain::forget_held_starts(with_friction(), 1, data));
  LONGS_EQUAL(0, data.experiments.front().first_scored);
}
