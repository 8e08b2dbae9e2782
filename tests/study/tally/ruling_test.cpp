// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/ruling.hpp"

#include <CppUTest/TestHarness.h>

#include "tools/study/tally/similarity.hpp"
#include "tools/study/tally/tally.hpp"

namespace hotfire::study {
namespace {

Judgement judged(std::vector<std::string> wanted, const std::vector<explain::FoundEffect>& effects, double after = 1.0) {
  Judgement judgement;
  judgement.wanted = std::move(wanted);
  judgement.is_wild = true;
  judgement.effect = {{"piston", 3.0}, {"engine", 10.0}};
  judgement.after = {{"piston", after}, {"engine", after}};
  judgement.below_noise = after < 1.0;
  for (const auto& effect : effects) {
    add_find(effect, judgement);
  }
  rule_on_unlisted({"gimbal_friction"}, judgement);
  return judgement;
}

explain::FoundEffect named(const char* name, const char* site) {
  explain::FoundEffect effect;
  effect.name = name;
  effect.site = site;
  return effect;
}

explain::FoundEffect among(const std::vector<std::string>& sites) {
  explain::FoundEffect effect;
  effect.sites = sites;
  return effect;
}

explain::FoundEffect without_name(const char* site) { return named("", site); }

explain::FoundEffect residual() { return named("residual", ""); }

const std::string kValve = "unlisted@valve_command|valve|flow";

}  // namespace

TEST_GROUP(StudyRuling){};

TEST(StudyRuling, OnlyTheNameOfAListedEffectThatIsNotMissingIsAWrongName) {
  CHECK_TRUE(judged({kValve}, {named("valve_deadband", "valve")}).wrong_name);
  CHECK_FALSE(judged({kValve}, {named("unlisted", "flow")}).wrong_name);
  CHECK_FALSE(judged({kValve}, {named("residual", "piston")}).wrong_name);
  CHECK_FALSE(judged({kValve}, {without_name("piston")}).wrong_name);
  CHECK_FALSE(judged({kValve}, {among({"valve", "flow"})}).wrong_name);
  // A true part of the unlisted one, and the listed one beside it.
  CHECK_FALSE(judged({"unlisted@engine_torque"}, {named("gimbal_friction", "engine_torque")}).wrong_name);
  CHECK_FALSE(judged({"valve_deadband", kValve}, {named("valve_deadband", "valve")}).wrong_name);
  CHECK_TRUE(judged({"valve_deadband", kValve}, {named("backlash", "load_spring")}).wrong_name);
}

TEST(StudyRuling, ASiteIsRightIfEverythingUnlistedIsAtOneThatIs) {
  CHECK_TRUE(judged({kValve}, {named("unlisted", "flow")}).site_right);
  CHECK_FALSE(judged({kValve}, {named("unlisted", "piston")}).site_right);
  CHECK_FALSE(judged({kValve}, {named("unlisted", "flow"), named("unlisted", "piston")}).site_right);
  CHECK_FALSE(judged({kValve}, {}).site_right);
  CHECK_TRUE(judged({kValve}, {among({"piston", "flow"})}).site_right);
  CHECK_FALSE(judged({kValve}, {among({"piston", "flow", "command", "structure", "load_spring"})}).site_right);
  CHECK_FALSE(judged({kValve}, {residual()}).site_right);
  // The listed one alone tells nothing of the other's site.
  CHECK_FALSE(judged({"valve_deadband", kValve}, {named("valve_deadband", "valve")}).site_right);
  CHECK_TRUE(judged({"valve_deadband", kValve}, {named("valve_deadband", "valve"), named("unlisted", "flow")}).site_right);
}

TEST(StudyRuling, TheListedOneIsNamedWhateverIsFoundBesideIt) {
  CHECK_TRUE(
      judged({"valve_deadband", kValve}, {named("valve_deadband", "valve"), named("unlisted", "piston")}).names_right);
  CHECK_FALSE(judged({"valve_deadband", kValve}, {named("unlisted", "valve")}).names_right);
}

TEST(StudyRuling, AnErrorIsHalvedWhereTheEffectShowsMost) {
  CHECK_TRUE(judged({kValve}, {}, 4.9).halved);
  CHECK_FALSE(judged({kValve}, {}, 5.1).halved);
  DOUBLES_EQUAL(0.49, *judged({kValve}, {}, 4.9).left(), 1e-12);
  DOUBLES_EQUAL(4.9, *judged({kValve}, {}, 4.9).over_noise(), 1e-12);
}

// 97, 85 and 85 of 100 are asked; beside a listed effect 27, 24 and 29 of 30.
TEST(StudyRuling, DrawnCasesAreHeldToTheirOwnFigures) {
  const Judgement good = judged({kValve}, {named("unlisted", "flow")});
  const Judgement wrong = judged({kValve}, {named("backlash", "load_spring")}, 9.0);
  std::vector<Judgement> hundred(97, good);
  hundred.insert(hundred.end(), 3, wrong);
  CHECK_TRUE(all_met(hundred));
  hundred.front() = wrong;
  CHECK_FALSE(all_met(hundred));
  UNSIGNED_LONGS_EQUAL(3, figures_of(hundred).size());

  const Judgement both = judged({"valve_deadband", kValve}, {named("valve_deadband", "valve"), named("unlisted", "flow")});
  const Judgement one = judged({"valve_deadband", kValve}, {named("valve_deadband", "valve")}, 4.0);
  std::vector<Judgement> thirty(24, both);
  thirty.insert(thirty.end(), 6, one);
  CHECK_TRUE(all_met(thirty));
  thirty.front() = one;
  CHECK_FALSE(all_met(thirty));
  // One that leaves less than the noise has found both.
  thirty.front() = judged({"valve_deadband", kValve}, {named("valve_deadband", "valve")}, 0.9);
  CHECK_TRUE(all_met(thirty));
}

TEST(StudyRuling, TwoSizesAgreeIfNamesAreTheSameAndErrorsWithinATenth) {
  SimilarPair pair{judged({kValve}, {named("backlash", "load_spring")}),
                   judged({kValve}, {named("backlash", "load_spring")})};
  CHECK_TRUE(pair.same_names() && pair.same_errors());
  pair.small_and_fast.after["piston"] = 1.12;
  CHECK_FALSE(pair.same_errors());
  pair.small_and_fast.after["piston"] = 1.1;
  CHECK_TRUE(pair.same_errors());
  pair.as_made.after["engine"] = 0.04;
  pair.small_and_fast.after["engine"] = 0.01;
  CHECK_TRUE(pair.same_errors());
  pair.small_and_fast.found = {"soft_stiffness"};
  CHECK_FALSE(pair.same_names());
}

}  // namespace hotfire::study
