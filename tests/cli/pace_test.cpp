// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/pace.hpp"

#include <utility>
#include <vector>

#include <CppUTest/TestHarness.h>

namespace hotfire::explain {

TEST_GROUP(Pace) {
  Pace pace{4};
  double done(Work work, double share = 0.0, std::size_t searches_to_come = 0) {
    return pace.done({work, "", share, searches_to_come}).expected;
  }
  double least_done(Work work, double share = 0.0) { return pace.done({work, "", share}).least; }
};

TEST(Pace, of_a_search_that_finds_one_effect_the_share_rises_to_the_end) {
  double before = -1.0;
  for (const auto& [work, share] : std::vector<std::pair<Work, double>>{{Work::calibrating, 0.0},
                                                                        {Work::locating, 0.0},
                                                                        {Work::screening, 0.5},
                                                                        {Work::screening, 1.0},
                                                                        {Work::fitting, 0.3},
                                                                        {Work::fitting, 0.8},
                                                                        {Work::deciding, 0.0},
                                                                        {Work::settling, 0.0},
                                                                        {Work::concluding, 0.0},
                                                                        {Work::concluding, 1.0}}) {
    const double now = done(work, share);
    CHECK(now > before);
    before = now;
  }
  DOUBLES_EQUAL(1.0, before, 1e-12);
}

TEST(Pace, what_is_left_out_is_no_longer_expected) {
  done(Work::calibrating);
  const double before = done(Work::locating);
  // Nothing is missing: the conclusion follows at once.
  CHECK(done(Work::concluding) > 2.0 * before);
}

TEST(Pace, another_round_adds_to_the_work_and_the_share_falls) {
  done(Work::calibrating);
  done(Work::screening, 1.0);
  const double before = done(Work::deciding);
  const double again = done(Work::screening, 0.1);
  CHECK(again < before);
  CHECK(done(Work::screening, 0.2) > again);
  // The same work once more without another one between.
  const double whole = done(Work::screening, 1.0);
  CHECK(done(Work::screening, 0.1) < whole);
}

TEST(Pace, of_a_search_that_takes_every_round_the_least_share_rises_to_the_end) {
  double before = least_done(Work::calibrating);
  for (int round = 0; round < 4; ++round) {
    for (const Work work : {Work::locating, Work::screening, Work::fitting, Work::deciding}) {
      const double now = least_done(work, 0.5);
      CHECK(now > before);
      before = now;
    }
  }
  for (const Work work : {Work::settling, Work::unlisted, Work::concluding}) {
    const double now = least_done(work, 1.0);
    CHECK(now > before);
    before = now;
  }
  DOUBLES_EQUAL(1.0, before, 1e-12);
}

TEST(Pace, the_least_share_is_below_the_expected_one_until_no_round_may_follow) {
  const ShareDone first = pace.done({Work::screening, "", 1.0});
  CHECK(first.least < 0.7 * first.expected);
  const ShareDone last = pace.done({Work::concluding, ""});
  DOUBLES_EQUAL(last.expected, last.least, 1e-12);
  Pace of_one_round{1};
  const ShareDone only = of_one_round.done({Work::screening, "", 1.0});
  CHECK(only.least > 1.5 * first.least);
}

TEST(Pace, without_a_search_the_calibration_is_the_work) {
  Pace of_calibration{0};
  const ShareDone now = of_calibration.done({Work::concluding, ""});
  CHECK(now.expected > 1.5 * done(Work::locating));
  DOUBLES_EQUAL(now.expected, now.least, 1e-12);
}

TEST(Pace, locating_what_is_left_at_the_end_is_no_other_round) {
  done(Work::screening, 1.0);
  const double before = done(Work::settling, 1.0);
  CHECK(done(Work::locating) >= before);
}

TEST(Pace, the_first_of_two_searches_is_at_most_half_of_the_work) { CHECK(done(Work::concluding, 1.0, 1) < 0.6); }

}  // namespace hotfire::explain
