// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_search.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/latent/correlation.hpp"
#include "tools/explain/latent/form_comb.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;
using explain::Form;
using explain::FormRegression;
using explain::LatentPlace;
using explain::ScoredForm;
using model::Argument;
using model::Memory;

constexpr LatentPlace kPistonSensor{std::nullopt, 0};

/// What a piston sensor adds that is a law of the command, which no smoother changes. A row is read before its command acts.
template <class Law>
Record with_reading(Law&& law) {
  Record record = record_of(declared());
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[1].values[row] += law(record.channels[0].values[row == 0 ? 0 : row - 1]);
  }
  return record;
}

/// The best form of the sensor's place for a record.
struct Best {
  explicit Best(const Record& record)
      : data(explain::make_dataset(declared(), {record})),
        problem(explain::latent_problem(data, about_declared(), 2)),
        input(explain::most_likely_input(problem, kPistonSensor)) {
    explain::smooth(problem, kPistonSensor, input);
    const FormRegression regression(problem, kPistonSensor, input, FormRegression::Arguments::simulated);
    form = explain::search_forms(regression, kPistonSensor, 1, 2).at(0);
  }

  explain::Dataset data;
  explain::LatentProblem problem;
  explain::LatentInput input;
  ScoredForm form;
};

}  // namespace

TEST_GROUP(FormSearch){};

// Eleven points over the range would put none inside of +-0.3 mrad, a twentieth of it.
TEST(FormSearch, ANarrowKinkIsFoundWithItsWidth) {
  static constexpr double kWidth = 3e-4;
  const Best best(with_reading([](double command) { return -0.5 * std::clamp(command, -kWidth, kWidth); }));
  CHECK(best.form.form.argument == Argument::command);
  CHECK(best.form.score.left < 1.1);
  const bool is_kink = best.form.form.memory.kind == Memory::saturation;
  CHECK(is_kink || best.form.form.has_curve());
  if (is_kink) {
    DOUBLES_EQUAL(kWidth, best.form.form.memory.width, 0.1 * kWidth);
  }
}

TEST(FormSearch, ACurveWithWavesIsFollowedToTheNoise) {
  const Best best(with_reading([](double command) { return 12.0 * kPistonNoise * std::sin(600.0 * command); }));
  CHECK(best.form.form.argument == Argument::command);
  CHECK(best.form.score.left < 1.3);
}

TEST_GROUP(CorrelationRatio){};

TEST(CorrelationRatio, AFunctionOfAnyShapeExplainsAllAndAnIndependentSignalNothing) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> x;
  std::vector<double> even;
  std::vector<double> noise;
  for (int i = 0; i < 20000; ++i) {
    x.push_back(uniform(random));
    even.push_back(x.back() * x.back() - 1.0 / 3.0);
    noise.push_back(uniform(random));
  }
  // Within a bin a parabola varies by a thousandth of its variance; 31 degrees of freedom of 20,000 are by chance.
  CHECK(explain::correlation_ratio(x, even) > 0.99);
  CHECK(explain::correlation_ratio(x, noise) < 0.005);
}
