// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/locate.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;
using explain::Located;

Located located_in(const ModelFile& truth, std::size_t copies = 1) {
  const explain::Dataset data = data_of(truth, copies);
  return explain::locate(data, about_declared(), 2);
}

}  // namespace

TEST_GROUP(Locate){};

TEST(Locate, NothingIsLocatedWhereNothingIsMissing) { CHECK(located_in(declared()).places.empty()); }

TEST(Locate, AWrongDeclaredValueWithinItsToleranceIsNoPlace) {
  ModelFile truth = declared();
  std::get<SimplexParameters>(truth.parameters).engine.inertia *= 1.02;
  CHECK(located_in(truth).places.empty());
}

TEST(Locate, AHardeningDuctActsAtTheEngineAndNowhereElse) {
  const Located located = located_in(with_effect<model::DuctHardening>({3e9}));
  CHECK(located.is_single);
  CHECK(located.allows("engine_torque"));
  for (const char* site : {"load_spring", "piston", "flow", "command", "sensor.piston", "sensor.engine"}) {
    CHECK(!located.allows(site));
  }
}

TEST(Locate, ABowedSensorIsTheSensorsAndNotThePlants) {
  const Located located = located_in(with_effect<model::SensorNonlinearity>({20.0, 0.0}, 1));
  CHECK(located.is_single);
  CHECK(located.allows("sensor.engine"));
  CHECK(!located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

TEST(Locate, ADeadBandActsOnTheOilWhichWithoutItsPressureNoSignalSeparatesFromTheValveOrThePiston) {
  const Located located = located_in(with_effect<model::ValveDeadband>({0.01}));
  CHECK(located.is_single);
  CHECK(located.allows("valve"));
  CHECK(located.allows("flow"));
  CHECK(!located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

// Where a friction sticks and slips, the linear flow grows by two orders of magnitude from one row to the next.
TEST(Locate, WhatIsMissingBesideAFrictionThatSticksIsLocated) {
  const ModelFile rubbing = with_effect<model::PistonFriction>({3400.0, 1.4, 0.0104, 4.1e8});
  ModelFile truth = rubbing;
  add_effect<model::DuctHardening>(std::get<SimplexParameters>(truth.parameters), [](auto& duct) { duct.cubic = 3e9; });
  explain::Fitted about = about_declared();
  about.base = rubbing.parameters;
  const Located located = explain::locate(data_of(truth), about, 2);
  CHECK(located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

// One signal at the piston represents what a rate limit and a leakage leave together.
TEST(Locate, ASignalCostsLessBesideARightEffectAndAsMuchBesideAWrongOne) {
  const ModelFile right = with_effect<model::RateLimit>({0.02});
  ModelFile truth = right;
  add_effect<model::Leakage>(std::get<SimplexParameters>(truth.parameters),
                             [](auto& leakage) { leakage.coefficient = 6e-11; });
  const explain::Dataset data = data_of(truth);
  const auto cost_beside = [&](const ModelFile& model) {
    explain::Fitted about = about_declared();
    about.base = model.parameters;
    return explain::cost_of_signal(data, about, {}, 2).cost;
  };
  const double alone = cost_beside(declared());
  CHECK(cost_beside(right) < 0.5 * alone);
  CHECK(cost_beside(with_effect<model::TorqueOffset>({3e3})) > 0.95 * alone);
  // Of both there is only noise left, which the readings' own quantum makes smaller than declared.
  CHECK(cost_beside(truth) < 0.05 * alone);
}

TEST(Locate, ASignalCostsTheSameFromThePriorsBesideAnotherModelAsFromAllPriors) {
  ModelFile truth = with_effect<model::RateLimit>({0.02});
  add_effect<model::Leakage>(std::get<SimplexParameters>(truth.parameters),
                             [](auto& leakage) { leakage.coefficient = 6e-11; });
  const explain::Dataset data = data_of(truth);
  const explain::SignalCost alone = explain::cost_of_signal(data, about_declared(), {}, 2);
  // Beside the limit the signal is smaller than alone, beside the offset it is the same.
  for (const ModelFile& model : {with_effect<model::RateLimit>({0.02}), with_effect<model::TorqueOffset>({3e3})}) {
    explain::Fitted about = about_declared();
    about.base = model.parameters;
    const double of_all = explain::cost_of_signal(data, about, {}, 2).cost;
    DOUBLES_EQUAL(of_all, explain::cost_of_signal(data, about, alone.priors, 2).cost, 0.01 * alone.cost);
  }
}

TEST(Locate, AnInvisibleMissingTermIsNoPlace) {
  // A thousandth of the torque that the test above locates: below what 20 s of the sensors show.
  CHECK(located_in(with_effect<model::DuctHardening>({3e6})).places.empty());
}

TEST(Locate, LongRecordsAreThinnedAndGiveTheSamePlace) {
  const Located located = located_in(with_effect<model::DuctHardening>({3e9}), 5);  // 50,000 rows
  CHECK(located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

TEST(Locate, OpeningAddsThePlacesThatLeaveAsLittleAndNoOthers) {
  Located located;
  located.is_single = true;
  located.places.resize(3);
  located.places[0].sites = {"sensor.piston"};
  located.places[0].is_possible = located.places[0].is_likely = true;
  located.places[1].sites = {"valve", "flow"};
  located.places[1].is_possible = true;
  located.places[2].sites = {"engine_torque"};
  const Located open = located.opened();
  CHECK(open.allows("sensor.piston") && open.allows("flow") && !open.allows("engine_torque"));
  const Located rest = open.beyond(located);
  CHECK(!rest.allows("sensor.piston") && rest.allows("valve") && !rest.allows("engine_torque"));
}

TEST(Locate, WhatOneSignalExplainsMayActAtEveryLikelyPlaceAndWhatNoneDoesAtTheBestAlone) {
  Located located;
  CHECK(!located.may_act_at("load_spring"));
  located.places.resize(3);
  located.places[0].sites = {"load_spring", "structure"};
  located.places[0].is_likely = true;
  located.places[1].sites = {"engine_torque"};
  located.places[1].is_likely = true;
  located.places[2].sites = {"piston"};
  CHECK(located.may_act_at("structure") && !located.may_act_at("engine_torque"));
  located.is_single = true;
  CHECK(located.may_act_at("load_spring") && located.may_act_at("engine_torque") && !located.may_act_at("piston"));
}
