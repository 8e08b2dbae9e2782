// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <memory>

#include "firmware/session/session.hpp"
#include "model/simplex.hpp"
#include "tests/firmware/session/scripted_world.hpp"

namespace hotfire::firmware {

using test::run_scripted;
using test::ScriptedWorld;
TEST_GROUP(Report) {
  ScriptedWorld world;
  PlantOptions options;
  std::unique_ptr<LoopResult> result;

  Session session() {
    world = ScriptedWorld{};
    world.delays[30].wake_up_ns = 250'000;
    world.delays[40].step_ns = 1'500'000;
    options.loop.cycles = 100;
    options.loop.warm_up_cycles = 10;
    options.command_line = "hotfire-rt \"quoted\"";
    result = std::make_unique<LoopResult>(run_scripted(world, options.loop));
    using Simplex = model::Simplex<double>;
    return {options, *result, Simplex::topology, Simplex::channels, Simplex::channel_units, 2};
  }

  void expect_bad(const char* reason) {
    const Verdict verdict = judge(session());
    CHECK(!verdict.good);
    STRCMP_EQUAL(reason, verdict.reason.c_str());
  }
};

TEST(Report, VerdictWithoutLimitsIsGoodAndSaysSo) {
  const Verdict verdict = judge(session());
  CHECK(verdict.good);
  STRCMP_EQUAL("no limit was set", verdict.reason.c_str());
}

TEST(Report, LimitOnOverrunsIsMetAtTheLimitAndBrokenBelowIt) {
  options.max_overruns = 1;
  CHECK(judge(session()).good);
  options.max_overruns = 0;
  expect_bad("1 overruns, allowed 0");
}

TEST(Report, LimitOnLatencyLooksAtTheLatestWakeUp) {
  options.max_latency_us = 250.0;
  CHECK(judge(session()).good);
  options.max_latency_us = 249.9;
  CHECK(!judge(session()).good);
}

TEST(Report, LimitOnTheStepLooksAtTheLongestOne) {
  options.max_step_us = 1500.0;
  CHECK(judge(session()).good);
  options.max_step_us = 1499.9;
  expect_bad("longest step 1500.0 us, allowed 1499.9 us");
}

TEST(Report, LimitsAreJudgedWithoutTheWarmUp) {
  options.max_latency_us = 0.0;
  options.max_overruns = 0;
  world = ScriptedWorld{};
  world.delays[5] = {400'000, 10'000, 3'000'000, 10'000};
  options.loop.cycles = 100;
  options.loop.warm_up_cycles = 10;
  result = std::make_unique<LoopResult>(run_scripted(world, options.loop));
  using Simplex = model::Simplex<double>;
  const Verdict verdict = judge({options, *result, Simplex::topology, Simplex::channels, Simplex::channel_units, 2});
  CHECK(verdict.good);
  UNSIGNED_LONGS_EQUAL(1, result->warm_up_overruns);
}

TEST(Report, CycleMissingInTheRecordingIsBadUnlessAllowed) {
  RecorderAccount account{100, 99, "the disk is full"};
  std::uint64_t most_dropped = 0;
  const auto with_recording = [&] {
    Session with = session();
    with.recording = &account;
    with.recording_file = "run.hfr";
    with.max_dropped = most_dropped;
    return with;
  };
  CHECK(!judge(with_recording()).good);
  STRCMP_CONTAINS("run.hfr: 99 of 100 cycles, 1 dropped; ended early: the disk is full",
                  text_report(with_recording()).c_str());
  STRCMP_CONTAINS("\"recording\":{\"file\":\"run.hfr\",\"offered\":100,\"stored\":99,\"dropped\":1",
                  json_report(with_recording()).c_str());
  most_dropped = 1;
  CHECK(judge(with_recording()).good);
  account.is_error = true;
  CHECK(!judge(with_recording()).good);
  LONGS_EQUAL(kHardware, judge(with_recording()).status);
  STRCMP_CONTAINS("the recording failed: the disk is full", judge(with_recording()).reason.c_str());
}

TEST(Report, FaultOfALabIsItsVerdictAlsoIfTheProfileHadBeenRunToItsEnd) {
  const auto verdict = [&](const LabAccount& account) {
    Session of_lab = session();
    of_lab.lab = account;
    return judge(of_lab);
  };
  LabAccount account{RigState::safe, true, 1};
  CHECK(verdict(account).good);
  account.first = Fault::emergency_stop;
  LONGS_EQUAL(kInterlock, verdict(account).status);
  STRCMP_CONTAINS("interlock: fault 9, emergency stop", verdict(account).reason.c_str());
  account = {RigState::safe, false, 1};
  LONGS_EQUAL(kBadVerdict, verdict(account).status);
  account = {RigState::safe, true, 1};
  account.left_the_bus = false;
  LONGS_EQUAL(kHardware, verdict(account).status);
  account = {RigState::safe, true, 1};
  account.lines_dropped = false;
  LONGS_EQUAL(kHardware, verdict(account).status);
  STRCMP_CONTAINS("take the supply away by hand", verdict(account).reason.c_str());
  account = {RigState::safe, true, 1};
  account.came_to_rest = false;
  LONGS_EQUAL(kBadVerdict, verdict(account).status);
  STRCMP_CONTAINS("a piston still moved", verdict(account).reason.c_str());
}

TEST(Report, RecordingThatFailedIsSaidAlsoIfALabWasStoppedOrFaulted) {
  RecorderAccount recording{100, 99, "the disk is full"};
  recording.is_error = true;
  Session of_lab = session();
  of_lab.recording = &recording;
  of_lab.max_dropped = 100;
  of_lab.lab = LabAccount{RigState::safe, false, 1};
  LONGS_EQUAL(kHardware, judge(of_lab).status);
  STRCMP_EQUAL("the recording failed: the disk is full", judge(of_lab).reason.c_str());
  of_lab.lab->first = Fault::emergency_stop;
  LONGS_EQUAL(kInterlock, judge(of_lab).status);
  STRCMP_CONTAINS("; the recording failed too: the disk is full", judge(of_lab).reason.c_str());
}

TEST(Report, LoopStoppedByAnOverrunIsBadWhateverTheLimits) {
  options.max_overruns = 10;
  options.loop.policy = OverrunPolicy::stop;
  const Verdict verdict = judge(session());
  CHECK(!verdict.good);
  STRCMP_EQUAL("stopped by an overrun", verdict.reason.c_str());
}

TEST(Report, TextNamesTheFiguresTheBlameAndThatItWasNoRealTime) {
  const std::string text = text_report(session());
  STRCMP_CONTAINS("real time     NO", text.c_str());
  STRCMP_CONTAINS("cycles        100 at 1000.0000 Hz", text.c_str());
  STRCMP_CONTAINS("overruns      1, by phase: wake_up 0, read 0, step 1, write 0, backlog 0", text.c_str());
  STRCMP_CONTAINS("worst cycle   40: wake-up 0.0, read 10.0, step 1500.0, write 10.0, account 0.0 us; longest: step",
                  text.c_str());
  STRCMP_CONTAINS("max 250.0 us", text.c_str());
  STRCMP_CONTAINS("as an ordinary process", text.c_str());
}

TEST(Report, JsonHasTheShapeOfCyclictestAndOurOwnBesideIt) {
  const std::string json = json_report(session());
  STRCMP_CONTAINS("{\"file_version\":1,\"cmdline:\":\"hotfire-rt \\\"quoted\\\"\",\"rt_test_version:\":\"hotfire ",
                  json.c_str());
  STRCMP_CONTAINS("\"return_code\":0,\"sysinfo\":{\"sysname\":\"Linux\"", json.c_str());
  STRCMP_CONTAINS(
      "\"num_threads\":1,\"resolution_in_ns\":0,\"thread\":{\"0\":{\"histogram\":{\"0\":98,\"250\":1},\"cycles\":100,"
      "\"min\":0,\"max\":250,\"avg\":",
      json.c_str());
  STRCMP_CONTAINS("\"overruns\":1,\"blame\":{\"wake_up\":0,\"read\":0,\"step\":1,\"write\":0,\"backlog\":0}", json.c_str());
}

}  // namespace hotfire::firmware
