// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/refiner.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "tests/explain/coloured_noise.hpp"
#include "tools/simulate/simulate.hpp"

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Evaluator;
using explain::Fitted;
using explain::Resolution;

/// Steps of a degree and back, simulated by the declared model, the piston read a hundredth of its way off; with or without
/// the load pressure, to which rough steps do most.
Dataset stepped(const ModelFile& model, bool with_pressure) {
  Record record;
  record.name = "steps.csv";
  record.path = record.name;
  record.period = 2e-3;
  record.rows = 6000;
  Channel command{"command", "rad", std::vector<double>(record.rows, 0.0)};
  for (std::size_t row = 500; row < record.rows; ++row) {
    command.values[row] = row / 1000 % 2 == 0 ? 0.0175 : 0.0;
  }
  record.channels.push_back(command);
  const Record modelled = simulate(model, record);
  record.channels.push_back(*modelled.find("piston"));
  for (double& piston : record.channels.back().values) {
    piston *= 1.01;
  }
  if (with_pressure) {
    record.channels.push_back(*modelled.find("load_pressure"));
  }
  return explain::make_dataset(model, {record});
}

bool screens_roughly(bool with_pressure) {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", 8e-6}, {"load_pressure", 8e3}};
  const Dataset data = stepped(model, with_pressure);
  const Evaluator rough(data, Resolution::rough);
  const Evaluator coarse(data, Resolution::coarse);
  const Evaluator fine(data, Resolution::fine);
  const explain::Scales scales;
  const explain::Watch watch;
  const explain::Refiner refiner(data, rough, coarse, fine, scales, 1, watch);
  Fitted declared;
  declared.base = model.parameters;
  declared.temper.assign(data.channels.size(), 1.0);
  return refiner.for_screening(declared).resolution() == Resolution::rough;
}

/// The candidate with a name and law.
explain::Candidate candidate_of(const Dataset& data, const std::string& name, const std::string& law = "") {
  for (const explain::Candidate& candidate : explain::all_candidates(DirectParameters(), data)) {
    if (candidate.name == name && candidate.option_name == law) {
      return candidate;
    }
  }
  return {};
}

/// A guided mass under a law of friction, its parameters `above` the typical ones in their coordinates, which are
/// logarithms.
Fitted guided_mass(const Dataset& data, const explain::Scales& scales, const std::string& law, double above) {
  Fitted model;
  DirectParameters declared;
  declared.mass.inertia = 1.0;
  declared.mass.damping = 0.5;
  declared.mass.stiffness = 100.0;
  model.base = declared;
  const explain::Candidate candidate = candidate_of(data, "sliding_friction", law);
  explain::activate(model.base, candidate);
  model.free = explain::effect_parameters(model.base, candidate, scales);
  for (const explain::FreeParameter& parameter : model.free) {
    model.u.push_back(parameter.coordinate(parameter.unit_size) + above);
  }
  model.temper.assign(data.channels.size(), 1.0);
  return model;
}

/// The mass under a law of friction pushed to and fro, read to a ten-thousandth of its travel.
Dataset pushed_to_and_fro(const std::string& law) {
  Record record;
  record.name = "strokes.csv";
  record.path = record.name;
  record.period = 5e-3;
  record.rows = 4000;
  record.channels = {{"force", "N", std::vector<double>(record.rows)}, {"position", "m", std::vector<double>(record.rows)}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * record.period;
    record.channels[0].values[row] = 20.0 * std::sin(1.7 * t) * std::sin(0.31 * t);
  }
  ModelFile model;
  model.parameters = DirectParameters{};
  model.noise = {{"position", 1e-5}};
  const Dataset shape = explain::make_dataset(model, {record});
  const Fitted truth = guided_mass(shape, {10.0, 0.1, 0.5}, law, 0.4);
  model.parameters = truth.parameters();
  record.channels[1].values = simulate(model, record).find("position")->values;
  const std::vector<double> noise = test::coloured_noise(record.rows, 0.0, 3);
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[1].values[row] += 1e-5 * noise[row];
  }
  return explain::make_dataset(model, {record});
}

/// The strokes, and what fits a model to them under one kind of steps.
struct Strokes {
  explicit Strokes(const std::string& law = "lugre") : data(pushed_to_and_fro(law)) {}

  Dataset data;
  Evaluator fine{data, Resolution::fine};
  explain::Scales scales{10.0, 0.1, 0.5};
  explain::Watch watch;
  explain::Refiner refiner{data, fine, fine, fine, scales, 2, watch};
};

}  // namespace

TEST_GROUP(Refiner){};

TEST(Refiner, FromASimplerLawTheOneThatTheDataHoldIsReachedAndFromThatNoFurther) {
  const Strokes strokes;
  const Dataset& data = strokes.data;
  const explain::Scales& scales = strokes.scales;
  const explain::Refiner& refiner = strokes.refiner;
  const auto dahl = refiner.ranked(guided_mass(data, scales, "dahl", 0.0), explain::kRanking);
  CHECK_FALSE(explain::reaches_noise(data, dahl));
  const auto richer = refiner.of_richer_laws(1, dahl, candidate_of(data, "sliding_friction", "dahl"));
  LONGS_EQUAL(1, richer.size());
  STRCMP_EQUAL("lugre", richer.front().candidate.option_name.c_str());
  CHECK_TRUE(explain::reaches_noise(data, richer.front().model));
  CHECK_TRUE(refiner.of_richer_laws(1, richer.front().model, richer.front().candidate).empty());
}

// LuGre holds Dahl at a static ratio of 1, the end of its range: a fit that ends just above it has an interval that reaches
// it.
TEST(Refiner, AParameterThatTheDataDoNotSeparateFromTheEndOfItsRangeIsLeftOutWithItsLaw) {
  for (const char* made : {"dahl", "lugre"}) {
    const Strokes strokes(made);
    auto lugre = strokes.refiner.ranked(guided_mass(strokes.data, strokes.scales, "lugre", 0.1), explain::kRanking);
    for (std::size_t k = 0; k < lugre.model.free.size(); ++k) {
      const explain::FreeParameter& parameter = lugre.model.free[k];
      if (parameter.address.field == "static_ratio") {
        lugre.model.u[k] = std::max(lugre.model.u[k], parameter.coordinate(1.0002 * parameter.lower));
      }
    }
    explain::Candidate law = candidate_of(strokes.data, "sliding_friction", "lugre");
    const auto simplest = strokes.refiner.by_simplest_law(lugre, law);
    STRCMP_EQUAL(made, law.option_name.c_str());
    CHECK_TRUE(explain::reaches_noise(strokes.data, simplest));
  }
}

TEST(Refiner, AnEffectInThePlaceOfAnotherIsFittedWithAllElseThatWasFound) {
  const Strokes strokes;
  const Dataset& data = strokes.data;
  const explain::Candidate dahl = candidate_of(data, "sliding_friction", "dahl");
  const explain::Candidate lugre = candidate_of(data, "sliding_friction", "lugre");
  const explain::Candidate quadratic = candidate_of(data, "quadratic_stiffness");
  Fitted model = guided_mass(data, strokes.scales, "dahl", 0.2);
  explain::activate(model.base, quadratic);
  for (const auto& parameter : explain::effect_parameters(model.base, quadratic, strokes.scales)) {
    model.free.push_back(parameter);
    model.u.push_back(0.0);
  }
  const auto with = strokes.refiner.in_place_of(model, dahl, lugre, guided_mass(data, strokes.scales, "lugre", 0.2));
  CHECK_TRUE(explain::reaches_noise(data, with));
  CHECK_TRUE(explain::is_active(with.model.base, quadratic.effect));
  LONGS_EQUAL(guided_mass(data, strokes.scales, "lugre", 0.0).free.size() + model.free.size() -
                  guided_mass(data, strokes.scales, "dahl", 0.0).free.size(),
              with.model.free.size());
}

// A linear move of what was free before may end anywhere: here where the mass runs away.
TEST(Refiner, AScreenedCandidateThatWasMovedTooFarIsFittedFromWhereTheErrorIsLeastOnTheWay) {
  const Strokes strokes;
  const Dataset& data = strokes.data;
  const explain::Scales& scales = strokes.scales;
  const explain::Refiner& refiner = strokes.refiner;
  Fitted screened = guided_mass(data, scales, "lugre", 0.2);
  const explain::Candidate earlier = candidate_of(data, "quadratic_stiffness");
  explain::activate(screened.base, earlier);
  const auto before = explain::effect_parameters(screened.base, earlier, scales);
  screened.free.insert(screened.free.begin(), before.begin(), before.end());
  screened.u.insert(screened.u.begin(), before.size(), 1e6);
  CHECK_FALSE(refiner.ranked(screened, explain::kRanking).good());
  CHECK_TRUE(explain::reaches_noise(data, refiner.of_screened(screened, std::vector<double>(before.size(), 0.0))));
}

TEST(Refiner, ScreensWithRoughStepsWhereTheyChangeLittleOfWhatIsLeft) { CHECK_TRUE(screens_roughly(false)); }

// What the pressure channel lacks is a thousandth of what the piston's does: over both channels together rough steps change
// next to nothing.
TEST(Refiner, ScreensWithRankingStepsWhereRoughOnesChangeOneChannelThatIsMetAlready) { CHECK_FALSE(screens_roughly(true)); }

// The next round moved the stiffness to where nothing fits.
TEST(Refiner, FromTheDeclaredValuesTheBetterOfTwoFitsIsKept) {
  const Strokes strokes;
  const Dataset& data = strokes.data;
  Fitted model = guided_mass(data, strokes.scales, "lugre", 0.4);
  const auto declared = explain::declared_parameters(model.base, {{"mass.stiffness", 0.05}});
  LONGS_EQUAL(1, declared.size());
  model.free.insert(model.free.begin(), declared.begin(), declared.end());
  model.u.insert(model.u.begin(), -18.0);
  const auto moved = explain::assess(strokes.fine, 1, model);
  CHECK_FALSE(explain::reaches_noise(data, moved));
  const auto again = strokes.refiner.from_declared_values(moved);
  CHECK_TRUE(explain::reaches_noise(data, again));
  DOUBLES_EQUAL(0.0, again.model.u.front(), 0.1);
  // Where the noise is reached already there is nothing to gain but what a rounding makes of it.
  const auto kept = strokes.refiner.from_declared_values(again);
  CHECK(explain::Goodness::combined(kept.goodness.held_out) <= explain::Goodness::combined(again.goodness.held_out));
}
