// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_regression.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/policy/policy.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;

constexpr explain::LatentPlace kPistonSensor{std::nullopt, 0};

/// The regression at the piston's sensor, which adds waves of the command. `size`: over the noise.
struct WithWaves {
  explicit WithWaves(double size)
      : data(explain::make_dataset(declared(), {record_with_waves(size)})),
        problem(explain::latent_problem(data, data, about_declared(), explain::Resolution::coarse, 2)),
        input(smoothed_input(problem)),
        regression(problem, kPistonSensor, input, explain::FormRegression::Arguments::simulated) {}

  static Record record_with_waves(double size) {
    Record record = record_of(declared());
    for (std::size_t row = 0; row < record.rows; ++row) {
      record.channels[1].values[row] += size * kPistonNoise * std::sin(600.0 * record.channels[0].values[row]);
    }
    return record;
  }

  static explain::LatentInput smoothed_input(const explain::LatentProblem& of) {
    explain::LatentInput likely = explain::most_likely_input(of, kPistonSensor);
    explain::smooth(of, kPistonSensor, likely);
    return likely;
  }

  explain::Dataset data;
  explain::LatentProblem problem;
  explain::LatentInput input;
  explain::FormRegression regression;
};

}  // namespace

TEST_GROUP(FormRegression){};

// What is left without a form is less than a single signal may leave. Half of it is still missing.
TEST(FormRegression, ASmallEffectIsNotExplainedByLessThanHalfOfIt) {
  const WithWaves waves(1.5);
  const double beyond = waves.regression.left_without() - 1.0;
  CHECK(beyond > 0.3 && 1.0 + beyond < explain::policy().left_by_single);
  CHECK(!waves.regression.is_explained_by(1.0 + 0.6 * beyond));
  CHECK(waves.regression.is_explained_by(1.0 + 0.4 * beyond));
}

// Half of a large effect is more than a single signal leaves.
TEST(FormRegression, ALargeEffectIsNotExplainedByHalfOfIt) {
  const WithWaves waves(6.0);
  CHECK(waves.regression.left_without() > 2.0 * explain::policy().left_by_single);
  CHECK(!waves.regression.is_explained_by(explain::policy().left_by_single + 0.1));
  CHECK(waves.regression.is_explained_by(explain::policy().left_by_single - 0.1));
}
