// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/identifiability.hpp"

#include <CppUTest/TestHarness.h>

#include "tools/explain/terms/candidates.hpp"

namespace {

using namespace hotfire::explain;

/// An axis whose load spring and inertia are known to 5 and 2 %, and what its data add to that: `along` counts how well they
/// identify the notch, `each` every coordinate by itself.
Fitted axis(double along, double each) {
  Fitted fitted;
  fitted.free = declared_parameters(fitted.base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});
  fitted.u.assign(2, 0.0);
  // In coordinates, in tolerances: the notch falls with J and rises with K_T, in series with the actuator.
  const hotfire::SimplexParameters declared;
  const double share = 1.0 / (1.0 + declared.structure.stiffness / declared.actuator.stiffness);
  Eigen::Vector2d notch;
  for (std::size_t k = 0; k < 2; ++k) {
    notch(static_cast<Eigen::Index>(k)) = fitted.free[k].key == "engine.inertia" ? -0.02 : share * 0.05;
  }
  fitted.normal = along * notch * notch.transpose() + (1.0 + each) * Eigen::Matrix2d::Identity();
  return fitted;
}

}  // namespace

TEST_GROUP(Identifiability){};

TEST(Identifiability, OfANotchOnlyItsFrequencyIsIdentified) {
  const auto sentences = not_separated(axis(1e7, 0.0));
  CHECK_EQUAL(1U, sentences.size());
  STRCMP_CONTAINS("K_T R^2 / J", sentences.front().c_str());
  STRCMP_CONTAINS("engine.inertia (", sentences.front().c_str());
  STRCMP_CONTAINS("structure.stiffness (", sentences.front().c_str());
  // One over the root of 1e7.
  STRCMP_CONTAINS("to 0.032 %. They do not identify its factors separately", sentences.front().c_str());
}

TEST(Identifiability, NoSentenceWhereEachIsDetermined) { CHECK_TRUE(not_separated(axis(1e7, 1e6)).empty()); }

TEST(Identifiability, WhereTheDataSayNothingTheDeclarationRemains) {
  const auto sentences = not_separated(axis(0.0, 0.0));
  CHECK_EQUAL(1U, sentences.size());
  STRCMP_CONTAINS("do not determine structure.stiffness, engine.inertia", sentences.front().c_str());
}

TEST(Identifiability, ParametersOfWhichOneMakesUpForTheOtherAreNamedWithTheirRate) {
  Fitted fitted;
  fitted.free = declared_parameters(fitted.base, {{"engine.viscous_damping", 0.3}, {"actuator.piston_damping", 0.3}});
  fitted.u.assign(2, 0.0);
  // The sum of their coordinates is identified a hundred times better than either: with one larger the other is smaller by
  // as much.
  const Eigen::Vector2d sum(1.0, 1.0);
  fitted.normal = 1e4 * sum * sum.transpose() + Eigen::Matrix2d::Identity();
  const auto sentences = not_separated(fitted);
  CHECK_EQUAL(1U, sentences.size());
  STRCMP_CONTAINS("With actuator.piston_damping larger by 1 %, engine.viscous_damping smaller by 1 %",
                  sentences.front().c_str());
}
