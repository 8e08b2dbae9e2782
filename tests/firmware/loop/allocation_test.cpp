// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "firmware/loop/loop.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/plant/reference_plant.hpp"
#include "firmware/session/live_session.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/sim/manual_clock.hpp"
#include "hal/sim/plant_bus.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

using test::AllocationGuard;

namespace {

using Simplex = model::Simplex<double>;
using Direct = model::Direct<double>;

/// Keeps the compiler from leaving out an allocation that nobody looks at.
void* volatile last_block = nullptr;

template <class Model, class Clock>
void check_that_loop_allocates_nothing(const typename Model::Parameters& parameters, std::uint64_t cycles) {
  Plant<Model> plant(parameters, 1e-3);
  hal::sim::SimulatedPlantBus bus({}, 1e-3);
  Clock clock;
  const auto loop = std::make_unique<Loop<Plant<Model>, hal::sim::SimulatedPlantBus, Clock>>(
      plant, bus, clock, LoopSettings{1'000'000, cycles, 0, OverrunPolicy::catch_up});
  const AllocationGuard guard;
  loop->run(false, []() noexcept {});
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
  UNSIGNED_LONGS_EQUAL(0, guard.releases());
  UNSIGNED_LONGS_EQUAL(cycles, loop->result().account.cycles());
}

}  // namespace

TEST_GROUP(Allocation){};

TEST(Allocation, GuardCountsAVectorUnderCppUTestsOwnOperatorNew) {
  if (!AllocationGuard::available) {
    return;
  }
  const AllocationGuard guard;
  {
    std::vector<double> vector(1000);
    last_block = vector.data();
  }
  CHECK(guard.allocations() >= 1);
  CHECK(guard.releases() >= 1);
}

TEST(Allocation, GuardCountsEveryKindOfAllocation) {
  if (!AllocationGuard::available) {
    return;
  }
  const AllocationGuard guard;
  last_block = std::malloc(10);
  last_block = std::realloc(last_block, 1000);
  std::free(last_block);
  last_block = std::calloc(10, 10);
  std::free(last_block);
  last_block = std::aligned_alloc(64, 128);
  std::free(last_block);
  void* block = nullptr;
  LONGS_EQUAL(0, posix_memalign(&block, 64, 128));
  std::free(block);
  UNSIGNED_LONGS_EQUAL(5, guard.allocations());
  UNSIGNED_LONGS_EQUAL(4, guard.releases());
}

TEST(Allocation, TenThousandCyclesOfTheFullSimplexAllocateNothing) {
  check_that_loop_allocates_nothing<Simplex, hal::sim::ManualClock>(reference_plant_with_every_effect(), 10'000);
}

TEST(Allocation, CyclesOfTheFullDirectMassAllocateNothing) {
  Direct::Parameters parameters;
  parameters.effects.active.fill(true);
  check_that_loop_allocates_nothing<Direct, hal::sim::ManualClock>(parameters, 10'000);
}

TEST(Allocation, CyclesThatAreShownInALiveViewAllocateNothing) {
  using Pace = OwnPace<hal::sim::ManualClock>;
  constexpr std::uint64_t kCycles = 10'000;
  Plant<Direct> plant({}, 1e-3);
  hal::sim::SimulatedPlantBus bus({}, 1e-3);
  hal::sim::ManualClock clock;
  RunOptions options;
  options.live_view = "/dev/shm/hotfire-allocation-" + std::to_string(getpid());
  CycleOutputs outputs;
  const auto loop =
      std::make_unique<Loop<Plant<Direct>, hal::sim::SimulatedPlantBus, hal::sim::ManualClock, Pace, CycleOutputs>>(
          plant, bus, clock, LoopSettings{1'000'000, kCycles, 0, OverrunPolicy::catch_up}, Pace(clock, 1'000'000), &outputs);
  LiveSession live(options);
  CHECK(!live.start(RecordedPlant::of(plant, {}), {}, loop->result(), outputs));
  CHECK(outputs.view != nullptr);
  const AllocationGuard guard;
  loop->run(false, []() noexcept {});
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
  UNSIGNED_LONGS_EQUAL(0, guard.releases());
  UNSIGNED_LONGS_EQUAL(kCycles, loop->result().account.cycles());
}

TEST(Allocation, CyclesOnTheRealClockAllocateNothing) {
  check_that_loop_allocates_nothing<Simplex, hal::PosixClock>(reference_plant_with_every_effect(), 100);
}

}  // namespace hotfire::firmware
