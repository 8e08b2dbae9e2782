// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "model/effects/actuator/piston_friction.hpp"
#include "tests/explain/coloured_noise.hpp"
#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/terms/assessed.hpp"

namespace {

using namespace hotfire;
using explain::Assessed;
using explain::Dataset;
using explain::Evaluator;
using explain::Fitted;
using explain::Resolution;

/// Rows of half a step of the model in a row of a record.
constexpr std::size_t kRowsInRow = 8;

/// A seal that sticks: LuGre, with a break-away force a third above the sliding one.
constexpr std::initializer_list<double> kSeal{5800.0, 1.37, 5.4e-3, 5.1e8};
ModelFile sticking() { return test::with_effect<model::PistonFriction>(kSeal, 1); }

/// What a model reads under slow strokes, 20 s at 500 Hz, simulated by rows of which a row of the record has
/// `rows_in_row`.
Record strokes_of(const ModelFile& model, std::size_t rows_in_row) {
  Record fast;
  fast.name = "strokes.csv";
  fast.path = fast.name;
  fast.period = 2e-3 / static_cast<double>(rows_in_row);
  fast.rows = 10000 * rows_in_row;
  Channel command{"command", "rad", {}};
  for (std::size_t row = 0; row < fast.rows; ++row) {
    const double t = 2e-3 * static_cast<double>(row / rows_in_row);
    command.values.push_back(5e-3 * std::sin(2.0 * std::numbers::pi * 0.4 * t) * (t < 0.5 ? 0.0 : 1.0));
  }
  fast.channels.push_back(command);
  const Record modelled = simulate(model, fast);
  Record record;
  record.name = fast.name;
  record.path = fast.path;
  record.period = 2e-3;
  record.rows = 10000;
  for (const Channel* channel : {fast.find("command"), modelled.find("piston"), modelled.find("load_pressure")}) {
    Channel thinned{channel->name, channel->unit, {}};
    for (std::size_t row = 0; row < fast.rows; row += rows_in_row) {
      thinned.values.push_back(channel->values[row]);
    }
    record.channels.push_back(thinned);
  }
  return record;
}

/// Rms of what half the step changes in the load pressure of that axis [Pa].
double step_error_of_pressure() {
  const std::vector<double> fine = strokes_of(sticking(), 1).find("load_pressure")->values;
  const std::vector<double> finer = strokes_of(sticking(), kRowsInRow).find("load_pressure")->values;
  double square = 0.0;
  for (std::size_t row = 0; row < fine.size(); ++row) {
    square += (fine[row] - finer[row]) * (fine[row] - finer[row]);
  }
  return std::sqrt(square / static_cast<double>(fine.size()));
}

/// Strokes of an axis that takes half the step of the model, with the noise of a sensor of the load pressure that is a third
/// of what the model's step is wrong by.
Dataset stroked(const ModelFile& truth) {
  Record record = strokes_of(truth, kRowsInRow);
  ModelFile given = test::declared();
  const double pressure_noise = step_error_of_pressure() / 3.0;
  given.noise = {{"piston", test::kPistonNoise}, {"load_pressure", pressure_noise}};
  const std::vector<double> white = test::coloured_noise(record.rows, 0.0, 5);
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[1].values[row] += test::kPistonNoise * white[row];
    record.channels[2].values[row] += pressure_noise * white[record.rows - 1 - row];
  }
  return explain::make_dataset(given, {record});
}

struct SlowStrokes {
  explicit SlowStrokes(const ModelFile& truth) : data(stroked(truth)) {}

  Assessed assessed(const ModelFile& model) const {
    Fitted fitted;
    fitted.base = model.parameters;
    fitted.temper.assign(data.channels.size(), 1.0);
    Assessed result = explain::assess(fine, 1, fitted);
    explain::measure_step_error(data, coarse, 1, result);
    return result;
  }

  Dataset data;
  Evaluator fine{data, Resolution::fine};
  Evaluator coarse{data, Resolution::coarse};
};

}  // namespace

TEST_GROUP(StepError){};

TEST(StepError, WhatAStepMakesOfStickAndSlipIsNothingToFind) {
  const SlowStrokes strokes(sticking());
  const Assessed truth = strokes.assessed(sticking());
  // The steps make three times the noise, by construction.
  const double left = explain::excess_over_noise(strokes.data, truth.prediction);
  CHECK(left > 2.5);
  CHECK(left < 3.5);
  DOUBLES_EQUAL(0.0, explain::excess_over_noise(strokes.data, truth), 1e-12);
  CHECK_TRUE(explain::reaches_noise(strokes.data, truth));
}

TEST(StepError, WhatIsWrongBeyondTheStepsIsLeft) {
  const SlowStrokes strokes(sticking());
  const Assessed wrong = strokes.assessed(test::with_effect<model::PistonFriction>({5600.0, 1.37, 5.4e-3, 5.1e8}, 1));
  CHECK(explain::excess_over_noise(strokes.data, wrong) > 1.0);
  CHECK_FALSE(explain::reaches_noise(strokes.data, wrong));
}

TEST(StepError, ASmoothAxisHasNoneThatIsMaterial) {
  const SlowStrokes strokes(test::declared());
  ModelFile slow = test::declared();
  std::get<SimplexParameters>(slow.parameters).servovalve.position_gain *= 0.98;
  const Assessed wrong = strokes.assessed(slow);
  CHECK(explain::excess_over_noise(strokes.data, wrong.prediction) > 1.0);
  CHECK_TRUE(wrong.step_error.empty());
}

// Under steps twice as long the best parameters of such an axis are others.
TEST(StepError, ARankIsNotOfWhatLongStepsMake) {
  const SlowStrokes strokes(sticking());
  const explain::Scales scales = explain::scales_of(sticking().parameters, strokes.data);
  const explain::Watch watch;
  const explain::Refiner refiner(strokes.data, strokes.coarse, strokes.coarse, strokes.fine, scales, 2, watch);
  Fitted start;
  start.base = sticking().parameters;
  start.temper.assign(strokes.data.channels.size(), 1.0);
  for (const explain::Candidate& candidate : explain::all_candidates(start.base, strokes.data)) {
    if (candidate.name == "piston_friction" && candidate.option_name == "lugre") {
      start.free = explain::effect_parameters(start.base, candidate, scales);
    }
  }
  LONGS_EQUAL(kSeal.size(), start.free.size());
  for (const double value : kSeal) {
    start.u.push_back(start.free[start.u.size()].coordinate(value));
  }
  const Assessed of_long = explain::refined(strokes.coarse, strokes.fine, 2, start, explain::kRanking);
  const Assessed ranked = refiner.ranked(start, explain::kRanking);
  const double left = explain::excess_over_noise(strokes.data, ranked.prediction);
  CHECK(left < 0.7 * explain::excess_over_noise(strokes.data, of_long.prediction));
  CHECK_TRUE(explain::reaches_noise(strokes.data, ranked));
}
