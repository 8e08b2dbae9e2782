// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <memory>

#include "hal/sim/sync_source.hpp"
#include "tests/firmware/session/scripted_world.hpp"

namespace hotfire::firmware {

using test::ScriptedBus;
using test::ScriptedPlant;
using test::ScriptedWorld;

namespace {

constexpr std::int64_t kSyncPacePeriod = ScriptedWorld::kPeriodNs;
using Syncs = hal::sim::SimulatedSyncSource<hal::sim::ManualClock>;
using Pace = SyncPace<hal::sim::ManualClock, Syncs>;

/// A plant that makes the syncs stop at one cycle and come again at another.
class SilencingPlant : public ScriptedPlant {
 public:
  SilencingPlant(ScriptedWorld& world, Syncs& syncs, std::uint64_t silent_from, std::uint64_t silent_to)
      : ScriptedPlant(world), world_(world), syncs_(syncs), silent_from_(silent_from), silent_to_(silent_to) {}

  void step(const hal::Command& command) noexcept {
    ScriptedPlant::step(command);
    if (world_.cycle == silent_from_ || world_.cycle == silent_to_) {
      syncs_.set_silent(world_.cycle == silent_from_);
    }
  }

 private:
  ScriptedWorld& world_;
  Syncs& syncs_;
  std::uint64_t silent_from_;
  std::uint64_t silent_to_;
};

}  // namespace

TEST_GROUP(SyncPace) {
  ScriptedWorld world;
  std::uint64_t silent_from = ~std::uint64_t{0};
  std::uint64_t silent_to = ~std::uint64_t{0};
  std::uint64_t most_missed = 5;
  std::int64_t patience = kSyncPacePeriod / 2;

  LoopResult run_locked(const LoopSettings& settings, std::int64_t sync_period_ns = kSyncPacePeriod) {
    Syncs syncs(world.clock, sync_period_ns);
    SilencingPlant plant(world, syncs, silent_from, silent_to);
    ScriptedBus bus(world);
    const auto loop = std::make_unique<Loop<SilencingPlant, ScriptedBus, hal::sim::ManualClock, Pace>>(
        plant, bus, world.clock, settings, Pace(world.clock, syncs, kSyncPacePeriod, most_missed, patience), nullptr);
    loop->run(false, []() noexcept {});
    return loop->result();
  }
};

// The rig's period is a thousandth longer than the loop's: a loop on its own clock would drift a period in a thousand
// cycles.
TEST(SyncPace, CyclesFollowTheSyncsAndNotTheLoopsOwnPeriod) {
  const std::int64_t rig_period = kSyncPacePeriod + 1000;
  const LoopResult result = run_locked({kSyncPacePeriod, 3000, 0, OverrunPolicy::catch_up}, rig_period);
  UNSIGNED_LONGS_EQUAL(3000, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.missed_syncs);
  UNSIGNED_LONGS_EQUAL(0, result.account.overruns());
  LONGS_EQUAL(3000 * rig_period + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(SyncPace, LatencyIsCountedFromTheArrivalOfTheSync) {
  world.delays[7].wake_up_ns = 123'000;
  LONGS_EQUAL(123'000, run_locked({kSyncPacePeriod, 20, 0, OverrunPolicy::catch_up}).account.latency().greatest_ns());
}

TEST(SyncPace, MissedSyncIsCountedAndItsCycleRunWithoutIt) {
  silent_from = 10;
  silent_to = 13;
  const LoopResult result = run_locked({kSyncPacePeriod, 100, 0, OverrunPolicy::catch_up});
  CHECK(result.ending == Ending::completed);
  UNSIGNED_LONGS_EQUAL(3, result.missed_syncs);
  UNSIGNED_LONGS_EQUAL(100, result.account.cycles());
  // No period was lost: the hundredth cycle comes with the hundredth sync.
  LONGS_EQUAL(100 * kSyncPacePeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(SyncPace, MoreThanTheMostMissedInARowEndTheLoop) {
  silent_from = 10;
  const LoopResult result = run_locked({kSyncPacePeriod, 100, 0, OverrunPolicy::catch_up});
  CHECK(result.ending == Ending::sync_lost);
  UNSIGNED_LONGS_EQUAL(most_missed + 1, result.missed_syncs);
}

TEST(SyncPace, PatienceWaitsForALateSyncInsteadOfRunningItsCycleWithoutIt) {
  patience = 300 * kSyncPacePeriod;
  const LoopResult result = run_locked({kSyncPacePeriod, 10, 0, OverrunPolicy::catch_up}, 250 * kSyncPacePeriod);
  UNSIGNED_LONGS_EQUAL(10, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.missed_syncs);
  LONGS_EQUAL(10 * 250 * kSyncPacePeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(SyncPace, CatchUpRunsACycleForEverySyncThatCameDuringAnOverrun) {
  world.delays[3].step_ns = 3 * kSyncPacePeriod + 500'000;
  const LoopResult result = run_locked({kSyncPacePeriod, 10, 0, OverrunPolicy::catch_up});
  UNSIGNED_LONGS_EQUAL(10, result.account.cycles());
  UNSIGNED_LONGS_EQUAL(0, result.missed_syncs);
  UNSIGNED_LONGS_EQUAL(1, result.account.blamed(Blame::step));
  LONGS_EQUAL(10 * kSyncPacePeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

TEST(SyncPace, SkipLeavesOutTheSyncsThatCameDuringAnOverrun) {
  world.delays[3].step_ns = 3 * kSyncPacePeriod + 500'000;
  const LoopResult result = run_locked({kSyncPacePeriod, 10, 0, OverrunPolicy::skip});
  UNSIGNED_LONGS_EQUAL(3, result.skipped);
  LONGS_EQUAL(13 * kSyncPacePeriod + 3 * ScriptedWorld::kPhaseNs, world.clock.now_ns());
}

namespace {

/// One sync that has come at a time.
struct OneSync {
  std::int64_t arrival_ns = 0;

  bool wait_for_sync(std::int64_t, hal::Sync& sync) noexcept {
    const bool there = arrival_ns != 0;
    sync = there ? hal::Sync{arrival_ns, 0} : sync;
    arrival_ns = 0;
    return there;
  }
};

}  // namespace

TEST(SyncPace, SyncThatCameAfterTheWritingIsNotOverdueAndHasItsCycle) {
  OneSync source{kSyncPacePeriod};
  SyncPace<hal::sim::ManualClock, OneSync> pace(world.clock, source, kSyncPacePeriod, most_missed, patience);
  Wake wake;
  CHECK(pace.wait(wake));
  source.arrival_ns = 5 * kSyncPacePeriod;
  UNSIGNED_LONGS_EQUAL(0, pace.drop_overdue(4 * kSyncPacePeriod));
  CHECK(pace.wait(wake));
  LONGS_EQUAL(5 * kSyncPacePeriod, wake.release_ns);
  source.arrival_ns = 6 * kSyncPacePeriod;
  UNSIGNED_LONGS_EQUAL(1, pace.drop_overdue(7 * kSyncPacePeriod));
}

TEST(SyncPace, LoopThatWaitsForItsFirstSyncCanBeAskedToStop) {
  Syncs syncs(world.clock, kSyncPacePeriod);
  syncs.set_silent(true);
  Pace pace(world.clock, syncs, kSyncPacePeriod, most_missed, patience);
  Wake wake;
  CHECK(!pace.wait(wake));
  LONGS_EQUAL(Pace::kLongestWaitNs, world.clock.now_ns());
  CHECK(!pace.lost());
}

namespace {

/// Answers that come a while after they are asked for; none while silent.
struct LateAnswers {
  hal::sim::ManualClock& clock;
  std::int64_t after_ns = 0;
  bool silent = false;

  bool wait_for_frame(std::int64_t deadline_ns, hal::CanFrame&, std::int64_t&) const noexcept {
    clock.sleep_until_ns(silent ? deadline_ns : clock.now_ns() + after_ns);
    return !silent;
  }
};

}  // namespace

TEST_GROUP(LockstepPace) {
  hal::sim::ManualClock clock;
  LateAnswers answers{clock};
  LockstepPace<hal::sim::ManualClock, LateAnswers> pace{clock, answers, kSyncPacePeriod};
  Wake wake;
};

TEST(LockstepPace, CyclesOfAQuickPlantAreAPeriodApart) {
  for (int cycle = 0; cycle < 5; ++cycle) {
    CHECK(pace.wait(wake));
    LONGS_EQUAL(cycle * kSyncPacePeriod, wake.release_ns);
  }
}

TEST(LockstepPace, NoCycleBeginsBeforeTheAnswerToTheLastOne) {
  CHECK(pace.wait(wake));
  answers.after_ns = 3 * kSyncPacePeriod;
  CHECK(pace.wait(wake));
  LONGS_EQUAL(3 * kSyncPacePeriod, wake.release_ns);
  CHECK(!wake.slept);
  answers.silent = true;
  CHECK(!pace.wait(wake));
}

}  // namespace hotfire::firmware
