// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/tally.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

#include "tools/study/draws/random.hpp"
#include "tools/study/tally/cost.hpp"

namespace hotfire::study {
namespace {

Judgement null_record(bool right) {
  Judgement judgement;
  judgement.names_right = right;
  judgement.below_noise = true;
  return judgement;
}

Judgement single(bool right, bool below) {
  Judgement judgement;
  judgement.wanted = {"backlash"};
  judgement.names_right = right;
  judgement.below_noise = below;
  return judgement;
}

std::vector<Judgement> repeated(const Judgement& judgement, std::size_t times) { return {times, judgement}; }

std::vector<Judgement> operator+(std::vector<Judgement> a, const std::vector<Judgement>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_GROUP(StudyTally){};

// None of n: the upper end solves (1 - p)^n = 0.025; all of n: the lower end solves p^n = 0.025.
TEST(StudyTally, AnExactIntervalHasItsClosedFormAtTheEnds) {
  const auto none = exact_interval(0, 40);
  DOUBLES_EQUAL(0.0, none[0], 0.0);
  DOUBLES_EQUAL(1.0 - std::pow(0.025, 1.0 / 40.0), none[1], 1e-12);
  const auto all = exact_interval(12, 12);
  DOUBLES_EQUAL(std::pow(0.025, 1.0 / 12.0), all[0], 1e-12);
  DOUBLES_EQUAL(1.0, all[1], 0.0);
}

// Of half of the trials the interval is symmetric, and 0.187 .. 0.813 for 5 of 10 in every table.
TEST(StudyTally, AnExactIntervalIsThatOfTheTables) {
  const auto half = exact_interval(5, 10);
  DOUBLES_EQUAL(1.0, half[0] + half[1], 1e-9);
  DOUBLES_EQUAL(0.1871, half[0], 5e-5);
}

TEST(StudyTally, TheLawOfAnEffectIsCountedAmongThoseNamedRightThatHaveOne) {
  Judgement right = single(true, true);
  right.wanted_law = "dahl";
  right.found_laws = {"dahl"};
  Judgement other = right;
  other.found_laws = {"lugre"};
  Judgement misnamed = right;
  misnamed.names_right = false;
  const std::string text = summary_of({right, right, other, misnamed, single(true, true)});
  STRCMP_CONTAINS("2 of 3, of those named right", text.c_str());
}

TEST(StudyTally, OneFalseFindInFortyIsMetAndTwoAreNot) {
  CHECK_TRUE(all_met(repeated(null_record(true), 39) + repeated(null_record(false), 1)));
  CHECK_FALSE(all_met(repeated(null_record(true), 38) + repeated(null_record(false), 2)));
  CHECK_FALSE(all_met(repeated(null_record(true), 5) + repeated(null_record(false), 1)));
}

TEST(StudyTally, NineteenOfTwentyNamesAndEighteenOfTwentyErrorsAreAskedFor) {
  CHECK_TRUE(
      all_met(repeated(single(true, true), 18) + repeated(single(true, false), 1) + repeated(single(false, false), 1)));
  CHECK_FALSE(all_met(repeated(single(true, true), 18) + repeated(single(false, true), 2)));
  CHECK_FALSE(all_met(repeated(single(true, true), 17) + repeated(single(true, false), 3)));
}

TEST(StudyTally, AnUnlistedEffectNeedsSiteAndHalfTheErrorAndNoWrongName) {
  Judgement good;
  good.wanted = {"unlisted@valve|flow"};
  good.site_right = good.halved = true;
  CHECK_TRUE(all_met(repeated(good, 6)));
  Judgement elsewhere = good;
  elsewhere.site_right = false;
  CHECK_TRUE(all_met(repeated(good, 5) + repeated(elsewhere, 1)));
  CHECK_FALSE(all_met(repeated(good, 4) + repeated(elsewhere, 2)));
  Judgement misnamed = good;
  misnamed.wrong_name = true;
  CHECK_FALSE(all_met(repeated(good, 5) + repeated(misnamed, 1)));
}

TEST_GROUP(StudyRandom){};

TEST(StudyRandom, StreamsOfOneNameAndSeedAreTheSameAndAllOthersDiffer) {
  CHECK_TRUE(Random("backlash-1", 1, 2).uniform(0.0, 1.0) == Random("backlash-1", 1, 2).uniform(0.0, 1.0));
  const double first = Random("backlash-1", 1, 2).uniform(0.0, 1.0);
  CHECK_TRUE(first != Random("backlash-1", 2, 2).uniform(0.0, 1.0));
  CHECK_TRUE(first != Random("backlash-1", 1, 3).uniform(0.0, 1.0));
  CHECK_TRUE(first != Random("leakage-1", 1, 2).uniform(0.0, 1.0));
}

// Of n = 1e5 normal numbers mean and variance lie within five standard deviations, 5 / sqrt(n) and 5 sqrt(2 / n).
TEST(StudyRandom, NormalNumbersHaveMeanZeroAndVarianceOne) {
  Random random("normal", 1);
  constexpr int kCount = 100'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
  }
  DOUBLES_EQUAL(0.0, sum / kCount, 5.0 / std::sqrt(1.0 * kCount));
  DOUBLES_EQUAL(1.0, squares / kCount, 5.0 * std::sqrt(2.0 / kCount));
}

TEST(StudyTally, ALineIsFoundWithWhatThePointsMissOfIt) {
  const CostLine exact = line_through({{10.0, 3.0, ""}, {20.0, 5.0, ""}, {40.0, 9.0, ""}});
  DOUBLES_EQUAL(1.0, exact.fixed, 1e-12);
  DOUBLES_EQUAL(0.2, exact.slope, 1e-12);
  DOUBLES_EQUAL(1.0, exact.correlation, 1e-12);
  // Of 1, 4, 9 over 1, 2, 3 the line is -10/3 + 4 x; it misses 2/3 of 98/3 square seconds.
  DOUBLES_EQUAL(1.0 - 2.0 / 98.0, line_through({{1.0, 1.0, ""}, {2.0, 4.0, ""}, {3.0, 9.0, ""}}).correlation, 1e-12);
}

}  // namespace hotfire::study
