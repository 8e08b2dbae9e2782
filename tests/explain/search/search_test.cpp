// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/search.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/explain/oscillator.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/explain/fit/goodness.hpp"
#include "tools/explain/policy/policy.hpp"

namespace {

using namespace hotfire;
using test::declared_oscillator;
using test::oscillator;

explain::SearchResult found_in(const Record& record, int most_effects = 4, double declared_stiffness = 97.0) {
  const ModelFile model = declared_oscillator(declared_stiffness);
  auto data = explain::make_dataset(model, {record});
  return explain::search(data, model, {2, most_effects, {}});
}

/// Takes the first rows out of a record.
void cut_start(Record& record, std::size_t rows) {
  record.rows -= rows;
  for (Channel& channel : record.channels) {
    channel.values.erase(channel.values.begin(), channel.values.begin() + static_cast<std::ptrdiff_t>(rows));
  }
}

/// Checks that a search in records of `truth` finds these effects and no others, and leaves noise.
void check_found(const ModelFile& truth, std::vector<std::string> wanted, const ModelFile& declared = test::declared()) {
  auto data = test::data_of(truth);
  const auto found = explain::search(data, declared, {2, 4, {}});
  std::vector<std::string> names;
  std::ranges::transform(found.kept, std::back_inserter(names), [](const auto& kept) { return kept.trial.candidate.name; });
  std::ranges::sort(names);
  std::ranges::sort(wanted);
  CHECK(names == wanted);
  CHECK(explain::excess_over_noise(data, found.explained.prediction) < explain::policy().visible);
}

}  // namespace

TEST_GROUP(Search){};
TEST_GROUP(SearchAtLength){};

// A record that begins 0.4 s after a step of the command: the slope of its first rows is within the noise.
TEST(Search, NothingIsFoundInARecordOfAnAxisThatMovedBeforeIt) {
  const ModelFile model = test::declared();
  Record record = test::record_under(
      model, [](double t) { return t < 1.0 ? 0.0 : 0.02 + 5e-3 * std::sin(3.0 * std::max(0.0, t - 4.0)); });
  cut_start(record, 690);
  auto data = explain::make_dataset(model, {record});
  LONGS_EQUAL(0, data.experiments.front().first_scored);
  const auto found = explain::search(data, model, {2, 4, {}});
  CHECK(data.experiments.front().first_scored > 900);
  CHECK(found.kept.empty());
  CHECK(explain::reaches_noise(data, found.explained));
}

// Steps under friction that holds, 0.8 s after one of them: what the friction leaves at every rest hides what the start
// leaves.
TEST(SearchAtLength, FrictionThatIsFoundShowsThatARecordStartsInMotion) {
  constexpr int kDahl = static_cast<int>(model::GimbalFriction::Law::dahl);
  Record record = test::record_under(test::with_effect<model::GimbalFriction>({1.15e4, 9.2e6}, kDahl), [](double t) {
    const double level = 0.01 - 0.002 * std::floor(t / 4.0);
    return t < 1.0 ? 0.0 : (std::fmod(t, 4.0) < 2.0 ? level : -level);
  });
  cut_start(record, 1400);
  const ModelFile model = test::declared();
  auto data = explain::make_dataset(model, {record});
  explain::search(data, model, {2, 0, {}});
  LONGS_EQUAL(0, data.experiments.front().first_scored);
  const auto found = explain::search(data, model, {2, 4, {}});
  // Its preload is halved by every reversal: after 2 s the true law itself leaves 34 times the noise, after 7 s twice.
  CHECK(data.experiments.front().first_scored > 3000);
  LONGS_EQUAL(1, found.kept.size());
  STRCMP_EQUAL("gimbal_friction", found.kept.front().trial.candidate.name.c_str());
}

// Beside a friction, the reading of the engine switches at random: that depends on nothing.
TEST(SearchAtLength, WhatWasLookedForBesideTheSameEffectsIsNotLookedForAgain) {
  constexpr int kDahl = static_cast<int>(model::GimbalFriction::Law::dahl);
  const ModelFile model = test::declared();
  Record record = test::record_of(test::with_effect<model::GimbalFriction>({1.15e4, 9.2e6}, kDahl));
  std::minstd_rand random(7);
  double added = 1e-4;
  std::size_t left = 0;
  for (double& reading : std::ranges::find(record.channels, "engine", &Channel::name)->values) {
    if (left-- == 0) {
      left = 50 + random() % 400;
      added = -added;
    }
    reading += added;
  }
  auto data = explain::make_dataset(model, {record});
  const auto found = explain::search(data, model, {2, 4, {}});
  CHECK(found.kept.size() == 1 && found.kept.front().trial.candidate.name == model::GimbalFriction::name);
  CHECK(explain::excess_over_noise(data, found.explained.prediction) > explain::policy().visible);
  std::map<int, std::set<std::string>> tried;  // by round
  for (const explain::Trial& trial : found.trials) {
    tried[trial.round].insert(label(trial.candidate) + std::to_string(trial.delta_criterion));
  }
  std::set<std::set<std::string>> rounds;
  for (const auto& [round, trials] : tried) {
    CHECK_TRUE(rounds.insert(trials).second);
  }
}

// A reading that is held for eight rows is late by half of that on average.
TEST(Search, AListedEffectIsReplacedByTheTermThatItImitates) {
  ModelFile truth = test::with_effect<model::Leakage>({6e-11});
  test::add_effect<model::Term<model::Site::sensor, 1>>(std::get<SimplexParameters>(truth.parameters), [](auto& term) {
    term.option = static_cast<int>(model::Memory::hold);
    term.argument = static_cast<int>(model::Argument::angle);
    term.gain = 1.0;
    term.direct = -1.0;
    term.time = 0.016;
  });
  check_found(truth, {"leakage", "term_engine_reading"});
}

// Both effects are at one sensor. A term alone would represent both.
TEST(Search, OfTwoEffectsOfOneSensorTheListedOneGetsItsName) {
  ModelFile truth = test::with_effect<model::SensorNonlinearity>({9.0, 300.0}, 0);
  test::add_effect<model::Term<model::Site::sensor, 0>>(std::get<SimplexParameters>(truth.parameters), [](auto& term) {
    term.option = static_cast<int>(model::Memory::delay);
    term.argument = static_cast<int>(model::Argument::position);
    term.factor = 1 + static_cast<int>(model::Argument::flow);
    term.gain = 300.0;
    term.time = 0.014;
  });
  check_found(truth, {"sensor_nonlinearity", "term_piston_reading"});
}

// The declared leakage, at 12 tolerances, would explain it as well.
TEST(Search, AnEffectForWhichADeclaredParameterCompensatesBeyondItsTolerancesIsFound) {
  ModelFile declared = test::declared();
  declared.tolerance["actuator.leakage"] = 0.1;
  check_found(test::with_effect<model::Leakage>({5e-12}), {"leakage"}, declared);
}

// The reference axis has 2 ms: closer rows cost time and separate nothing, and there are no others to leave out.
TEST(Search, CandidatesAreRankedOnRowsThatTheServoFollows) {
  Record record = test::record_of(test::declared());
  const auto period_of_ranks = [&](double period) {
    record.period = period;
    const auto data = explain::make_dataset(test::declared(), {record});
    return explain::rows_for_ranks(data, test::declared()).experiments.front().period;
  };
  DOUBLES_EQUAL(2e-3, period_of_ranks(2e-4), 1e-9);
  DOUBLES_EQUAL(2e-3, period_of_ranks(1e-3), 1e-9);
  DOUBLES_EQUAL(2e-3, period_of_ranks(2e-3), 1e-9);
  DOUBLES_EQUAL(5e-3, period_of_ranks(5e-3), 1e-9);
  const ModelFile mass = declared_oscillator(97.0);
  const auto of_mass = explain::make_dataset(mass, {oscillator(0.0, 1e-3)});
  const double period = of_mass.experiments.front().period;
  DOUBLES_EQUAL(period, explain::rows_for_ranks(of_mass, mass).experiments.front().period, 0.0);
}

TEST(Search, ACubicStiffnessNobodyDeclaredIsFoundWithItsValueAndNothingElse) {
  const auto found = found_in(oscillator(400.0, 1e-3));
  LONGS_EQUAL(1, found.kept.size());
  STRCMP_EQUAL("cubic_stiffness", found.kept[0].trial.candidate.name.c_str());
  const auto& model = found.explained.model;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k].key == "effects.cubic_stiffness.stiffness") {
      // The cubic force is rms 5 % of the linear one: noise of 1e-3 over 4500 samples leaves it known to a few per cent.
      DOUBLES_EQUAL(400.0, model.free[k].value(model.u[k]), 0.1 * 400.0);
    }
  }
  // Held-out error down to the noise: rms of residual over noise within 5 % of 1.
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.explained.goodness.held_out), 0.1);
}

TEST(Search, AWrongDeclaredValueIsCalibratedAndNotTakenForAMissingEffect) {
  const auto found = found_in(oscillator(0.0, 1e-3));
  LONGS_EQUAL(0, found.kept.size());
  LONGS_EQUAL(0, found.trials.size());
  CHECK(explain::Goodness::combined(found.declared.goodness.held_out) > 2.0);
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.calibrated.goodness.held_out), 0.1);
}

// Seven tolerances of 5 % below 100: no effect is missing, but the declaration cannot be trusted that far without a look.
TEST(SearchAtLength, ACalibrationFarBeyondItsTolerancesIsLookedBeyondAndStillGetsNoEffectsName) {
  const auto found = found_in(oscillator(0.0, 1e-3), 4, 74.0);
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.calibrated.goodness.held_out), 0.1);
  CHECK(!found.trials.empty());
  LONGS_EQUAL(0, found.kept.size());
}

TEST(Search, AForceThatNoListedEffectHasIsTakenDownAsATableOverWhatItDependsOn) {
  const auto found = found_in(oscillator(0.0, 1e-3, 2.0));
  LONGS_EQUAL(1, found.kept.size());
  STRCMP_EQUAL("unlisted_force", found.kept[0].trial.candidate.name.c_str());
  STRCMP_EQUAL("position", found.kept[0].trial.candidate.option_name.c_str());
  CHECK(explain::held_out_ratio(found.explained, found.calibrated) < 0.5);
  // What was tried is told in the order in which it was.
  CHECK(std::is_sorted(found.trials.begin(), found.trials.end(),
                       [](const auto& a, const auto& b) { return a.round < b.round; }));
}

TEST(Search, ADeclaredEffectIsCalibratedWithinItsToleranceAndOneWithoutSupportIsSaid) {
  ModelFile model = declared_oscillator(100.0);
  auto& parameters = std::get<DirectParameters>(model.parameters);
  test::add_effect<model::CubicStiffness>(parameters, [](auto& values) { values.stiffness = 250.0; });
  test::add_effect<model::QuadraticStiffness>(parameters, [](auto& values) { values.stiffness = 1e-3; });
  model.tolerance["effects.cubic_stiffness.stiffness"] = 0.5;
  auto data = explain::make_dataset(model, {oscillator(400.0, 1e-3)});
  const auto found = explain::search(data, model, {2, 4, {}});
  LONGS_EQUAL(0, found.kept.size());
  const auto& calibrated = found.calibrated.model;
  double cubic = 0.0;
  for (std::size_t k = 0; k < calibrated.free.size(); ++k) {
    cubic =
        calibrated.free[k].key == "effects.cubic_stiffness.stiffness" ? calibrated.free[k].value(calibrated.u[k]) : cubic;
  }
  DOUBLES_EQUAL(400.0, cubic, 0.1 * 400.0);
  LONGS_EQUAL(1, found.not_supported.size());
  STRCMP_EQUAL("quadratic_stiffness", found.not_supported[0].name.c_str());
}

TEST(Search, AllowedNoEffectItCalibratesAndLooksForNoneUnlistedEither) {
  const auto found = found_in(oscillator(400.0, 1e-3), 0);
  LONGS_EQUAL(0, found.trials.size());
  LONGS_EQUAL(0, found.kept.size());
  CHECK(found.explained.model.u == found.calibrated.model.u);
  // What is missing is still there, where the effect leaves the noise alone.
  CHECK(explain::Goodness::combined(found.explained.goodness.held_out) > 2.0);
}
