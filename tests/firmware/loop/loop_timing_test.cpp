// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <limits>

#include "tests/firmware/session/scripted_world.hpp"

namespace hotfire::firmware {

using test::run_scripted;
using test::ScriptedWorld;
namespace {

constexpr std::int64_t kPeriod = ScriptedWorld::kPeriodNs;

LoopSettings settings(std::uint64_t cycles, OverrunPolicy policy = OverrunPolicy::catch_up, std::uint64_t warm_up = 0) {
  return {kPeriod, cycles, warm_up, policy};
}

}  // namespace

TEST_GROUP(LoopTiming) {
  ScriptedWorld world;

  void check_blame(const LoopResult& result, Blame blame) {
    UNSIGNED_LONGS_EQUAL(1, result.account.overruns());
    UNSIGNED_LONGS_EQUAL(1, result.account.blamed(blame));
    CHECK(result.account.worst().blame == blame);
    UNSIGNED_LONGS_EQUAL(3, result.account.worst().cycle);
  }
};

TEST(LoopTiming, UndisturbedLoopSleepsOnceACycleAndNeverOverruns) {
  const LoopResult result = run_scripted(world, settings(1000));
  UNSIGNED_LONGS_EQUAL(1000, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.account.overruns());
  UNSIGNED_LONGS_EQUAL(1000, world.clock.sleeps());
  UNSIGNED_LONGS_EQUAL(1000, result.account.latency().count());
  DOUBLES_EQUAL(1000.0, result.account.rate(), 1e-9);
  CHECK(result.ending == Ending::completed);
}

TEST(LoopTiming, DeadlinesAreAbsoluteSoThatWorkDoesNotDriftTheSchedule) {
  run_scripted(world, settings(100));
  LONGS_EQUAL(100 * kPeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

// A delay that ends inside the next period leaves no backlog beyond one cycle, which then meets its own deadline.
TEST(LoopTiming, DelayInTheWakeUpIsBlamedOnTheWakeUp) {
  world.delays[3].wake_up_ns = kPeriod + 500'000;
  check_blame(run_scripted(world, settings(10)), Blame::wake_up);
}

TEST(LoopTiming, DelayInTheReadIsBlamedOnTheRead) {
  world.delays[3].read_ns = kPeriod + 500'000;
  check_blame(run_scripted(world, settings(10)), Blame::read);
}

TEST(LoopTiming, DelayInTheStepIsBlamedOnTheStep) {
  world.delays[3].step_ns = kPeriod + 500'000;
  check_blame(run_scripted(world, settings(10)), Blame::step);
}

TEST(LoopTiming, DelayInTheWriteIsBlamedOnTheWrite) {
  world.delays[3].write_ns = kPeriod + 500'000;
  check_blame(run_scripted(world, settings(10)), Blame::write);
}

TEST(LoopTiming, WorstCycleKeepsTheTimeOfEveryPhase) {
  world.delays[3] = {50'000, 20'000, 600'000, 30'000};
  const LoopResult result = run_scripted(world, settings(10));
  const CycleAccount::Worst& worst = result.account.worst();
  UNSIGNED_LONGS_EQUAL(3, worst.cycle);
  LONGS_EQUAL(50'000, worst.phases_ns[0]);
  LONGS_EQUAL(20'000, worst.phases_ns[1]);
  LONGS_EQUAL(600'000, worst.phases_ns[2]);
  LONGS_EQUAL(30'000, worst.phases_ns[3]);
  LONGS_EQUAL(700'000, worst.total_ns);
  UNSIGNED_LONGS_EQUAL(0, result.account.overruns());
}

TEST(LoopTiming, CycleThatEndsExactlyWhenTheNextIsDueIsInTime) {
  world.delays[3].step_ns = kPeriod - 2 * ScriptedWorld::kPhaseNs;
  UNSIGNED_LONGS_EQUAL(0, run_scripted(world, settings(10)).account.overruns());
  ScriptedWorld later;
  later.delays[3].step_ns = kPeriod - 2 * ScriptedWorld::kPhaseNs + 1;
  UNSIGNED_LONGS_EQUAL(1, run_scripted(later, settings(10)).account.overruns());
}

TEST(LoopTiming, CatchUpRunsEveryCycleAndReachesTheScheduleAgain) {
  world.delays[3].step_ns = 3 * kPeriod + 500'000;
  const LoopResult result = run_scripted(world, settings(10));
  UNSIGNED_LONGS_EQUAL(10, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.skipped);
  // Cycles 4 and 5 are over their deadline only because cycle 3 was; cycle 6 begins late and meets its deadline.
  UNSIGNED_LONGS_EQUAL(3, result.account.overruns());
  UNSIGNED_LONGS_EQUAL(1, result.account.blamed(Blame::step));
  UNSIGNED_LONGS_EQUAL(2, result.account.blamed(Blame::backlog));
  UNSIGNED_LONGS_EQUAL(7, result.account.latency().count());
  LONGS_EQUAL(10 * kPeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(LoopTiming, SkipLeavesOutTheCyclesAlreadyDueAndKeepsThePhase) {
  world.delays[3].step_ns = 3 * kPeriod + 500'000;
  const LoopResult result = run_scripted(world, settings(10, OverrunPolicy::skip));
  UNSIGNED_LONGS_EQUAL(10, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(1, result.account.overruns());
  UNSIGNED_LONGS_EQUAL(3, result.skipped);
  UNSIGNED_LONGS_EQUAL(10, result.account.latency().count());
  LONGS_EQUAL(13 * kPeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(LoopTiming, NumberOfACycleCountsWhatWasLeftOutBeforeItWhereTheWorldGoesOnWithoutTheLoop) {
  for (const bool number_skipped : {false, true}) {
    world = ScriptedWorld{};
    world.delays[3].step_ns = 3 * kPeriod + 500'000;
    world.delays[5].step_ns = kPeriod;
    LoopSettings asked = settings(20, OverrunPolicy::skip);
    asked.number_skipped = number_skipped;
    struct Heads {
      void record(const hal::CycleHead& head, std::span<const double>, std::span<const double>) noexcept {
        all[count++] = head;
      }
      std::array<hal::CycleHead, 20> all{};
      std::size_t count = 0;
    } heads;
    test::ScriptedPlant plant(world);
    test::ScriptedBus bus(world);
    using Clock = hal::sim::ManualClock;
    Loop<test::ScriptedPlant, test::ScriptedBus, Clock, OwnPace<Clock>, Heads> loop(
        plant, bus, world.clock, asked, OwnPace<Clock>(world.clock, asked.period_ns), &heads);
    loop.run(std::atomic<bool>(false), []() noexcept {});
    std::uint64_t skipped = 0;
    for (std::size_t i = 0; i < heads.count; ++i) {
      skipped += heads.all[i].skipped_before();
      UNSIGNED_LONGS_EQUAL(i + skipped, heads.all[i].cycle);
      // The number says when the cycle was due.
      const std::int64_t due = heads.all[0].release_ns + static_cast<std::int64_t>(heads.all[i].cycle) * kPeriod;
      CHECK(!number_skipped || heads.all[i].release_ns == due);
    }
    UNSIGNED_LONGS_EQUAL(number_skipped ? 4 : 0, skipped);
    UNSIGNED_LONGS_EQUAL(4, loop.result().skipped);
  }
}

TEST(LoopTiming, StopEndsTheLoopWithTheFirstOverrun) {
  world.delays[3].step_ns = 2 * kPeriod;
  const LoopResult result = run_scripted(world, settings(10, OverrunPolicy::stop));
  CHECK(result.ending == Ending::overrun);
  UNSIGNED_LONGS_EQUAL(4, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(4, world.sent);
}

TEST(LoopTiming, WarmUpIsCountedApartAndLeavesNoBacklogBehind) {
  world.delays[2].step_ns = 5 * kPeriod;
  world.delays[9].wake_up_ns = 4 * kPeriod;
  const LoopResult result = run_scripted(world, settings(10, OverrunPolicy::stop, 10));
  CHECK(result.ending == Ending::completed);
  UNSIGNED_LONGS_EQUAL(10, result.warm_up_cycles);
  UNSIGNED_LONGS_EQUAL(2, result.warm_up_overruns);
  UNSIGNED_LONGS_EQUAL(10, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.account.overruns());
  UNSIGNED_LONGS_EQUAL(0, result.skipped);
  LONGS_EQUAL(0, result.account.latency().greatest_ns());
}

TEST(LoopTiming, LatencyHistogramCountsEachWakeUpInItsMicrosecond) {
  world.delays[2].wake_up_ns = 4'999;
  world.delays[4].wake_up_ns = 4'000;
  world.delays[6].wake_up_ns = 12'345;
  const LoopResult result = run_scripted(world, settings(10));
  const Histogram& latency = result.account.latency();
  UNSIGNED_LONGS_EQUAL(7, latency.counts()[0]);
  UNSIGNED_LONGS_EQUAL(2, latency.counts()[4]);
  UNSIGNED_LONGS_EQUAL(1, latency.counts()[12]);
  LONGS_EQUAL(12'345, latency.greatest_ns());
}

TEST(LoopTiming, HeldCommandsAndLostReadingsAreCounted) {
  const LoopResult result = run_scripted(world, settings(10));
  UNSIGNED_LONGS_EQUAL(5, result.held_commands);
  UNSIGNED_LONGS_EQUAL(2, result.lost_readings);
}

TEST(LoopTiming, LoopThatIsAskedToStopRunsNoFurtherCycle) {
  const std::atomic<bool> stop{true};
  const LoopResult result = run_scripted(world, settings(0), stop);
  CHECK(result.ending == Ending::asked);
  UNSIGNED_LONGS_EQUAL(0, world.sent);
}

TEST(LoopTiming, ValueThatIsNotFiniteIsNeverSent) {
  world.measured = std::numeric_limits<double>::quiet_NaN();
  const LoopResult result = run_scripted(world, settings(10));
  CHECK(result.ending == Ending::not_finite);
  UNSIGNED_LONGS_EQUAL(0, world.sent);
}

}  // namespace hotfire::firmware
