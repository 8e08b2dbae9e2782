// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/progress.hpp"

#include <functional>
#include <optional>
#include <sstream>

#include <CppUTest/TestHarness.h>

namespace hotfire {

TEST_GROUP(Progress) {
  std::ostringstream to;
  double now = 0.0;
  std::function<double()> clock() {
    return [this] { return now; };
  }
};

TEST(Progress, of_a_share_of_the_work_the_line_has_a_bar_and_the_time_left) {
  Progress progress(to, true, std::nullopt, clock());
  now = 30.0;
  progress.say("F9", 0.25);
  STRCMP_EQUAL("\r\x1b[K[#####...............] 25 %, about 1 min 30 s left: F9", to.str().c_str());
}

TEST(Progress, before_anything_is_done_no_time_left_is_guessed) {
  Progress progress(to, true, std::nullopt, clock());
  progress.say("F1", 0.0);
  STRCMP_EQUAL("\r\x1b[K[....................] 0 %: F1", to.str().c_str());
}

TEST(Progress, of_a_command_with_a_time_limit_the_line_has_the_longest_time_left) {
  Progress progress(to, true, 60.0, clock());
  now = 15.0;
  progress.say("round 1");
  STRCMP_EQUAL("\r\x1b[K[#####...............] 15 s, at most 45 s left: round 1", to.str().c_str());
  now = 61.0;
  to.str("");
  progress.say("writing");
  STRCMP_EQUAL("\r\x1b[K[####################] 1 min 1 s, at most 0 s left: writing", to.str().c_str());
}

TEST(Progress, of_a_share_and_a_time_limit_the_shorter_time_left_is_said) {
  Progress progress(to, true, 60.0, clock());
  now = 15.0;
  progress.say("round 1", 0.5);
  STRCMP_EQUAL("\r\x1b[K[##########..........] 50 %, about 15 s left: round 1", to.str().c_str());
  to.str("");
  progress.say("round 1", 0.1);
  STRCMP_EQUAL("\r\x1b[K[##..................] 10 %, at most 45 s left: round 1", to.str().c_str());
}

TEST(Progress, of_a_work_of_unknown_extent_the_line_has_the_shortest_and_the_longest_time_left) {
  Progress progress(to, true, std::nullopt, clock());
  now = 15.0;
  progress.say("round 1", 0.5, 0.1);
  STRCMP_EQUAL("\r\x1b[K[##########..........] 50 %, about 15 s to 2 min 15 s left: round 1", to.str().c_str());
  to.str("");
  progress.say("concluding", 0.5, 0.5);
  STRCMP_EQUAL("\r\x1b[K[##########..........] 50 %, about 15 s left: concluding", to.str().c_str());
}

TEST(Progress, the_longest_time_left_ends_at_the_time_limit) {
  Progress progress(to, true, 60.0, clock());
  now = 15.0;
  progress.say("round 1", 0.5, 0.1);
  STRCMP_EQUAL("\r\x1b[K[##########..........] 50 %, about 15 s to 45 s left: round 1", to.str().c_str());
}

TEST(Progress, in_a_log_a_short_command_leaves_nothing_and_a_long_one_a_line_every_ten_seconds) {
  {
    Progress progress(to, false, std::nullopt, clock());
    for (now = 0.0; now < 35.0; now += 0.5) {
      progress.say("working");
      if (now < 10.0) {
        STRCMP_EQUAL("", to.str().c_str());
      }
    }
  }
  STRCMP_EQUAL("[ 10.0 s] working\n[ 20.0 s] working\n[ 30.0 s] working\n", to.str().c_str());
}

TEST(Progress, in_a_log_the_bar_and_the_time_left_are_those_of_a_terminal) {
  Progress progress(to, false, std::nullopt, clock());
  now = 30.0;
  progress.say("F9", 0.25);
  STRCMP_EQUAL("[#####...............] 25 %, about 1 min 30 s left: F9\n", to.str().c_str());
}

TEST(Progress, a_terminal_has_an_empty_line_behind_it) {
  { Progress progress(to, true, std::nullopt, clock()); }
  STRCMP_EQUAL("\r\x1b[K", to.str().c_str());
}

}  // namespace hotfire
