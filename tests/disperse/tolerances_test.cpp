// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/tolerances.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire::disperse {

TEST_GROUP(Tolerances) {
  test::Scratch scratch;

  std::filesystem::path taos() const {
    return scratch.write(
        "taos.toml",
        "schema = 1\ntopology = \"taos\"\n[structure]\nstiffness = 1e8\n[structure.yaw]\nstiffness = 1.2e8\n"
        "[gimbal]\nthrust = 1e6\n[effects.soft_stiffness]\nlaw = \"compliance\"\nlow_stiffness = 5e7\n"
        "load_scale = 6e3\n[tolerance]\nengine.inertia = 0.02\nstructure.yaw.stiffness = 0.1\n");
  }
  Tolerances load(const std::string& text) const {
    DeclaredModel model(taos());
    return load_tolerances(scratch.write("tolerances.toml", "schema = 1\n" + text), model);
  }
  std::string refusal_of(const std::string& text) const {
    return test::refusal([&] { load(text); });
  }
  static double number(DeclaredModel model, const std::string& key) {
    for (const DeclaredNumber& own : model.numbers()) {
      if (own.keys.back() == key) {
        return *own.value;
      }
    }
    FAIL(key.c_str());
    return 0.0;
  }
};

TEST(Tolerances, TheDeclaredModelComesBackBitForBitWithoutDeviation) {
  DeclaredModel model(taos());
  const Tolerances own = load("[tolerance]\nengine.inertia = 0.02\ngimbal.thrust = 0.01\n");
  const DeclaredModel same = with_variables(model, own.variables, Eigen::VectorXd::Zero(2));
  STRCMP_EQUAL(model.text().c_str(), same.text().c_str());
}

TEST(Tolerances, AKeyOfAllAxesMovesEachByOneFactorAndAKeyOfOneAxisThatOneToo) {
  const DeclaredModel model(taos());
  const Tolerances own = load("[tolerance]\nstructure.stiffness = 0.1\nstructure.yaw.stiffness = 0.2\n");
  const DeclaredModel drawn = with_variables(model, own.variables, Eigen::Vector2d(1.0, -0.5));
  DOUBLES_EQUAL(1e8 * 1.1, number(drawn, "structure.pitch.stiffness"), 1.0);
  DOUBLES_EQUAL(1.2e8 * 1.1 * 0.9, number(drawn, "structure.yaw.stiffness"), 1.0);
}

TEST(Tolerances, SizesAreConvertedToTheUnitOfTheirKey) {
  const Tolerances own = load(
      "[tolerance]\ngimbal.pitch_misalignment = {deviation = \"2 mm\", within = 2}\n"
      "gimbal.thrust = {low = \"900 kN\", high = 1.1e6}\n");
  LONGS_EQUAL(2, own.variables.size());
  for (const Tolerance& tolerance : own.variables) {
    if (tolerance.spread == Spread::between) {
      DOUBLES_EQUAL(9e5, tolerance.at(0.0), 1e-6);
      DOUBLES_EQUAL(1e6, tolerance.at(0.5), 1e-6);
      DOUBLES_EQUAL(1.1e6, tolerance.at(1.0), 1e-6);
    } else {
      DOUBLES_EQUAL(2e-3, tolerance.applied(0.0, 1.0), 1e-18);
      STRCMP_EQUAL("m", tolerance.unit.c_str());
    }
  }
}

TEST(Tolerances, AVariableThatIsCutOffStaysWithin) {
  const Tolerance cut{.key = "x", .size = 0.1, .within = 2.0};
  CHECK(cut.at(1e-12) >= -2.0);
  CHECK(cut.at(1.0 - 1e-12) <= 2.0);
  CHECK(cut.at(0.999) > 1.9);
  DOUBLES_EQUAL(0.0, cut.at(0.5), 1e-15);
}

TEST(Tolerances, LocationsAreAVariableForEachKeyWithTheirCorrelation) {
  const Tolerances own = load(
      "[tolerance]\nengine.inertia = 0.02\n[locations.load]\nkeys = [\"structure.pitch.stiffness\", "
      "\"structure.yaw.stiffness\"]\nsigma = 0.1\ncorrelation = 0.6\n");
  LONGS_EQUAL(3, own.variables.size());
  DOUBLES_EQUAL(0.6, own.correlation(1, 2), 0.0);
  DOUBLES_EQUAL(0.0, own.correlation(0, 1), 0.0);
  STRCMP_EQUAL("structure.yaw.stiffness", own.variables[2].key.c_str());
}

TEST(Tolerances, WithoutAFileThoseOfTheModelAreDrawn) {
  DeclaredModel model(taos());
  const Tolerances own = tolerances_of(taos(), model);
  LONGS_EQUAL(2, own.variables.size());
  STRCMP_EQUAL("engine.inertia", own.variables[0].key.c_str());
  STRCMP_EQUAL("structure.yaw.stiffness", own.variables[1].key.c_str());
  DOUBLES_EQUAL(0.1, own.variables[1].size, 0.0);
}

TEST(Tolerances, WhatIsWrongIsRefusedWithItsPlaceAndARemedy) {
  test::expect_message(refusal_of("[tolerance]\nengine.inetria = 0.02\n"),
                       {"tolerances.toml:3:", "engine.inetria", "engine.inertia"});
  test::expect_message(refusal_of("[tolerance]\nengine.inertia = -0.02\n"), {"tolerances.toml:3:", "-0.02", "above 0"});
  test::expect_message(refusal_of("[tolerance]\nengine.inertia = {sigma = 0.1, low = 3}\n"),
                       {"tolerances.toml:3", "no single spread"});
  test::expect_message(refusal_of("[tolerance]\nengine.inertia = {sgima = 0.1, within = 3}\n"), {"sgima"});
  test::expect_message(refusal_of("[tolerance]\ngimbal.thrust = {deviation = \"3 mm\"}\n"),
                       {"tolerances.toml:3:", "3 mm", "N"});
  test::expect_message(refusal_of("[tolerance]\ngimbal.thrust = {low = 5, high = 4}\n"), {"not above low = 5"});
  test::expect_message(refusal_of("[tolerance]\ngimbal.pitch_misalignment = 0.1\n"), {"declares 0", "deviation"});
  test::expect_message(refusal_of("tolerance = 3\n"), {"tolerances.toml:2:", "must be a table"});
  test::expect_message(refusal_of(""), {"tolerances.toml:1", "tolerance: missing"});
  test::expect_message(refusal_of("[tolerances]\nengine.inertia = 0.1\n"),
                       {"tolerances.toml:2", "did you mean \"tolerance\"?"});
  test::expect_message(refusal_of("[locations.a]\nkeys = [\"engine.inertia\"]\nsigma = 0.1\ncorrelation = 0\n"),
                       {"tolerances.toml:3:", "two keys"});
  const std::string two =
      "[locations.a]\nkeys = [\"structure.pitch.stiffness\", \"structure.yaw.stiffness\"]\nsigma = 0.1\n";
  test::expect_message(refusal_of(two), {"tolerances.toml:2", "correlation", "missing"});
  test::expect_message(refusal_of(two + "correlation = 1\n"), {"tolerances.toml:5:", "positive definite"});
  test::expect_message(refusal_of(two + "correlation = [[1, 0.5], [0.4, 1]]\n"), {"tolerances.toml:5:", "symmetric"});
  test::expect_message(refusal_of("[tolerance]\nstructure.yaw.stiffness = 0.1\n" + two + "correlation = 0\n"),
                       {"tolerances.toml:5:", "structure.yaw.stiffness", "already"});
}

}  // namespace hotfire::disperse
