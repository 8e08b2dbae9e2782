// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/assessed.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"

namespace {

using namespace hotfire::explain;

/// A model whose held-out residuals are these many times the noise, channel by channel.
Assessed leaving(const std::vector<double>& errors) {
  Assessed assessed;
  for (const double error : errors) {
    assessed.goodness.held_out.push_back({.rows = 100.0, .mean_square = error * error});
  }
  return assessed;
}

/// The declared model with what it predicts of records.
Assessed declared_about(const Dataset& data) {
  Assessed declared;
  declared.model = hotfire::test::about_declared();
  CHECK(Evaluator(data, Resolution::fine)
            .predict(declared.model.base, declared.model.free, declared.model.u, 1, declared.prediction));
  return declared;
}

}  // namespace

TEST_GROUP(Assessed){};

TEST(Assessed, OneChannelThatIsFarOffDoesNotHideWhatAnEffectDoesToTheOther) {
  // A play found while the engine's sensor reads a twentieth too much.
  CHECK(held_out_ratio(leaving({18.0, 1.0}), leaving({18.0, 6.0})) < 0.5);
  // sqrt(1/6): the geometric mean of 1 and a sixth.
  DOUBLES_EQUAL(0.408, held_out_ratio(leaving({18.0, 1.0}), leaving({18.0, 6.0})), 1e-3);
}

TEST(Assessed, WhatClearsTheWorstChannelCountsByTheRmsOverAll) {
  // rms of 3 and 1 over that of 30 and 1; the geometric mean of the two ratios would be 0.32.
  DOUBLES_EQUAL(std::sqrt(10.0 / 901.0), held_out_ratio(leaving({3.0, 1.0}), leaving({30.0, 1.0})), 1e-12);
}

TEST(Assessed, AModelThatLeavesClearlyMoreOfOneChannelLeavesMoreHoweverFarOffTheOtherIs) {
  CHECK_TRUE(leaves_clearly_more(leaving({18.0, 6.0}), leaving({18.0, 1.0})));
  // Half of the mean square is clearly less: 1.43 times the rms is clearly more.
  CHECK_FALSE(leaves_clearly_more(leaving({18.0, 1.4}), leaving({18.0, 1.0})));
  CHECK_TRUE(leaves_clearly_more(leaving({18.0, 1.45}), leaving({18.0, 1.0})));
  CHECK_FALSE(leaves_clearly_more(leaving({18.0, 1.0}), leaving({30.0, 6.0})));
}

TEST(Assessed, HeldOutErrorHasToFallWhereTheRowsContainWhatIsMissing) {
  CHECK_TRUE(held_out_rows_agree(leaving({1.0, 2.0}), leaving({1.0, 6.0})));
  CHECK_FALSE(held_out_rows_agree(leaving({1.0, 6.0}), leaving({1.0, 6.0})));
}

TEST(Assessed, HeldOutRowsAtTheNoiseRefuteOnlyWhatMakesThemWorse) {
  CHECK_TRUE(held_out_rows_agree(leaving({1.0, 1.02}), leaving({1.0, 1.02})));
  CHECK_FALSE(held_out_rows_agree(leaving({1.0, 1.1}), leaving({1.0, 1.02})));
  // At 1.42 times the noise of one channel what is missing is as large as the noise there.
  CHECK_FALSE(held_out_rows_agree(leaving({1.0, 1.42}), leaving({1.0, 1.42})));
}

TEST(Assessed, BesideACalibrationBeyondItsTolerancesHeldOutRowsHaveToConfirm) {
  Assessed calibrated = leaving({1.0, 1.02});
  calibrated.model.free = declared_parameters(calibrated.model.base, {{"engine.inertia", 0.02}});
  calibrated.model.u = {1.0};
  CHECK_TRUE(held_out_rows_agree(leaving({1.0, 1.02}), calibrated));
  calibrated.model.u = {7.0};
  CHECK_FALSE(held_out_rows_agree(leaving({1.0, 1.02}), calibrated));
}

TEST(Assessed, ADeclaredParameterSixTolerancesOffReplacesSomethingAndAnEffectsOwnDoesNot) {
  Fitted model;
  model.free = declared_parameters(model.base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});
  model.u = {2.0, -4.0};
  CHECK(is_within_tolerances(model));
  model.u = {2.0, -6.0};
  CHECK_FALSE(is_within_tolerances(model));
  model.free[1].scale = FreeParameter::Scale::logarithmic;
  CHECK(is_within_tolerances(model));
}

TEST(Assessed, AtTheNoiseAModelWithinItsTolerancesIsMoreCredibleThanOneBeyond) {
  const Dataset data = hotfire::test::data_of(hotfire::test::declared());
  const Assessed within = declared_about(data);
  Assessed beyond = within;
  beyond.model.u[0] = 6.0;
  CHECK_TRUE(is_more_credible(data, within, beyond));
  CHECK_FALSE(is_more_credible(data, within, within));
  CHECK_FALSE(is_more_credible(data, beyond, beyond));
  // Above the noise the error decides, not this.
  Assessed far = beyond;
  for (double& reading : far.prediction[0][0]) {
    reading += hotfire::test::kPistonNoise;
  }
  CHECK_FALSE(is_more_credible(data, within, far));
  CHECK_FALSE(is_more_credible(data, far, beyond));
}

TEST(Assessed, AModelWhoseEffectIsAsFarFromItsTypicalValuesIsNotMoreCredibleThanACompensation) {
  const Dataset data = hotfire::test::data_of(hotfire::test::declared());
  Assessed without = declared_about(data);
  Assessed with = without;
  without.model.u[0] = 6.0;
  // An effect's parameter has a prior, and no declared value.
  with.model.free.push_back(with.model.free[0]);
  with.model.free.back().scale = FreeParameter::Scale::logarithmic;
  // 5.8 squared and log 2 of one more parameter are less than 6 squared; 6.1 squared is not.
  with.model.u.push_back(5.8);
  CHECK_TRUE(is_more_credible(data, with, without));
  with.model.u.back() = 6.1;
  CHECK_FALSE(is_more_credible(data, with, without));
}

TEST(Assessed, ADeclaredValueMovedByTolerancesKeepsItsSignAndComesBackFromItsCoordinate) {
  const Fitted model;
  const auto free = declared_parameters(model.base, {{"actuator.piston_damping", 0.3}});
  LONGS_EQUAL(1, free.size());
  DOUBLES_EQUAL(free[0].declared, free[0].value(0.0), 1e-9);
  DOUBLES_EQUAL(1.3, free[0].value(1.0) / free[0].declared, 1e-12);
  for (const double u : {-40.0, -3.0, -1.0, 0.5, 4.0}) {
    CHECK(free[0].value(u) > 0.0);
    DOUBLES_EQUAL(u, free[0].coordinate(free[0].value(u)), 1e-9);
    DOUBLES_EQUAL((free[0].value(u + 1e-6) - free[0].value(u - 1e-6)) / 2e-6, free[0].slope(u), 1e-6 * free[0].slope(u));
  }
}
