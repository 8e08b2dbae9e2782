// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/unlisted_search.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/explain/oscillator.hpp"
#include "tools/explain/data/start_state.hpp"
#include "tools/explain/fit/scales.hpp"
#include "tools/explain/refine/finalists.hpp"

namespace {

using namespace hotfire;

/// A mass with detents that no listed effect has, calibrated.
struct Detents {
  ModelFile model = declared_oscillator();
  explain::Dataset data = explain::make_dataset(model, {test::oscillator(0.0, 1e-3, 2.0)});
  explain::Evaluator evaluator{data, explain::Resolution::fine};
  explain::Scales scales = explain::scales_of(model.parameters, data);
  explain::Watch watch;
  explain::Refiner refiner{data, evaluator, evaluator, evaluator, scales, 2, watch};
  explain::Assessed calibrated = refiner.settled(start());

  static ModelFile declared_oscillator() { return test::declared_oscillator(97.0); }
  explain::Fitted start() const {
    explain::Fitted declared;
    declared.base = model.parameters;
    declared.free = explain::declared_parameters(declared.base, model.tolerance);
    declared.u.assign(declared.free.size(), 0.0);
    for (const explain::FreeParameter& state : explain::initial_states(data, scales, declared.u)) {
      declared.free.push_back(state);
    }
    declared.temper.assign(data.channels.size(), 1.0);
    return declared;
  }
};

explain::Trial trial_at(const char* site, double evidence, double held_out_ratio) {
  explain::Trial trial;
  trial.candidate.site = site;
  trial.delta_criterion = -evidence;
  trial.held_out_ratio = held_out_ratio;
  trial.refined = true;
  trial.decision = "dropped";
  return trial;
}

/// A search of one term.
explain::UnlistedSearch search_of(const explain::Trial& trial, double left) {
  return {.trials = {trial}, .left = {left}, .best = 0, .model = {}};
}

}  // namespace

TEST_GROUP(UnlistedSearch){};

TEST(UnlistedSearch, OfTwoSearchesTheTermWithTheLeastHeldOutErrorIsTheBestAndAllTrialsStay) {
  explain::UnlistedSearch first = search_of(trial_at("sensor.piston", 2872.0, 0.997), 0.5);
  first.add(search_of(trial_at("valve", 23697.0, 0.945), 0.1));
  CHECK_EQUAL(2U, first.trials.size());
  CHECK_EQUAL(2U, first.left.size());
  STRCMP_EQUAL("valve", first.trials[*first.best].candidate.site.c_str());
  first.add(search_of(trial_at("piston", 100.0, 0.99), 0.4));
  STRCMP_EQUAL("valve", first.trials[*first.best].candidate.site.c_str());
  explain::UnlistedSearch nothing;
  nothing.add({});
  CHECK_FALSE(nothing.best.has_value());
}

TEST(UnlistedSearch, ATermAtAnotherSiteIsTiedOnlyIfItLeavesAsLittleWithHalfOfTheEvidence) {
  explain::UnlistedSearch found = search_of(trial_at("valve", 1000.0, 0.5), 0.1);
  found.add(search_of(trial_at("flow", 600.0, 0.6), 0.5));
  found.add(search_of(trial_at("piston", 400.0, 0.6), 0.5));
  found.add(search_of(trial_at("command", 600.0, 0.9), 2.0));
  found.mark_tied_sites();
  STRCMP_EQUAL("dropped", found.trials[0].decision.c_str());
  STRCMP_EQUAL("tied", found.trials[1].decision.c_str());
  STRCMP_EQUAL("dropped", found.trials[2].decision.c_str());
  STRCMP_EQUAL("dropped", found.trials[3].decision.c_str());
}

TEST(UnlistedSearch, TermsThatLeaveMoreOfARecordThanTheCalibratedModelAreRefusedAndOthersAreFittedInTheirPlace) {
  const Detents mass;
  // A calibrated model that leaves nothing: every term that leaves more than noise is worse than that.
  explain::Prediction perfect = mass.calibrated.prediction;
  perfect[0][0] = mass.data.experiments[0].measured[0];
  const explain::Located anywhere;
  const auto found = explain::search_unlisted({.data = mass.data,
                                               .refiner = mass.refiner,
                                               .beside = mass.calibrated,
                                               .calibrated = perfect,
                                               .located = anywhere,
                                               .scales = mass.scales,
                                               .threads = 2,
                                               .watch = mass.watch});
  CHECK_FALSE(found.best.has_value());
  CHECK_FALSE(found.leaves_less_than(1.0));
  const std::string& first = found.trials.front().reason;
  CHECK_TRUE(found.trials.front().held_out_ratio < 0.5);
  STRCMP_CONTAINS("refused", first.c_str());
  const auto fitted = std::ranges::count_if(found.trials, &explain::Trial::refined);
  CHECK_COMPARE(fitted, >, static_cast<std::ptrdiff_t>(explain::kUnlistedFinalists));
  CHECK_COMPARE(fitted, <, static_cast<std::ptrdiff_t>(found.trials.size()));
}

// What screening leaves of a table and of a term of the grammar are not measured on the same residuals.
TEST(UnlistedSearch, ATableIsFittedAlsoWhereATermOfTheGrammarIsAccepted) {
  using Friction = model::UnlistedMotion<model::Site::engine_torque>;
  ModelFile truth = test::declared();
  test::add_effect<Friction>(std::get<SimplexParameters>(truth.parameters), [](auto& friction) {
    friction.option = static_cast<int>(Friction::Law::friction_along_position);
    friction.stiffness = 1e8;
    friction.table.points = 3;
    friction.table.x = {-8e-3, 0.0, 8e-3};
    friction.table.y = {4e3, 0.0, 4e3};
  });
  const explain::Dataset data = test::data_of(truth);
  const explain::Evaluator rough(data, explain::Resolution::rough);
  const explain::Evaluator coarse(data, explain::Resolution::coarse);
  const explain::Scales scales = explain::scales_of(truth.parameters, data);
  const explain::Watch watch;
  const explain::Refiner refiner{data, rough, coarse, coarse, scales, 2, watch};
  const explain::Assessed calibrated = refiner.settled(test::about_declared());
  explain::Located located = explain::locate(data, calibrated.model, 2);
  std::erase_if(located.places, [](const explain::Place& place) { return !place.has("engine_torque"); });
  CHECK_EQUAL(1U, located.places.size());
  const auto found = explain::search_unlisted({.data = data,
                                               .refiner = refiner,
                                               .beside = calibrated,
                                               .calibrated = calibrated.prediction,
                                               .located = located,
                                               .scales = scales,
                                               .threads = 2,
                                               .watch = watch});
  const auto is_fitted = [](const char* name) {
    return [name](const explain::Trial& trial) { return trial.refined && trial.candidate.name == name; };
  };
  CHECK_TRUE(std::ranges::any_of(found.trials, is_fitted("term_torque")));
  CHECK_TRUE(std::ranges::any_of(found.trials, is_fitted("unlisted_torque")));
}
