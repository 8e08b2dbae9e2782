// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/controller_bus.hpp"

#include <CppUTest/TestHarness.h>

#include "firmware/can/bus_load.hpp"
#include "firmware/can/plant_bus.hpp"
#include "firmware/can/sync_source.hpp"
#include "hal/sim/can_wire.hpp"
#include "hal/sim/manual_clock.hpp"

namespace hotfire::firmware::can {
namespace {

using Wire = hal::sim::CanWire;
using Clock = hal::sim::ManualClock;
using Controller = ControllerBus<Wire::Node, Clock>;
static_assert(hal::PlantBus<Controller>);

constexpr std::int64_t kControllerBusMillisecond = 1'000'000;
constexpr std::size_t kActuators = 8;

/// Frames that came at made-up times.
class ListedFrames {
 public:
  bool wait_for_frame(std::int64_t deadline_ns, hal::CanFrame& frame, std::int64_t& arrival_ns) noexcept {
    (void)deadline_ns;
    if (next == frames.size()) {
      return false;
    }
    frame = frames[next];
    arrival_ns = static_cast<std::int64_t>(++next) * kControllerBusMillisecond;
    return true;
  }
  void add(std::uint8_t counter, bool damaged = false) {
    hal::CanFrame frame;
    CHECK(encode(sync::kMessage, {}, counter, frame));
    frame.data[0] ^= damaged ? 1 : 0;
    frames.push_back(frame);
  }

  std::vector<hal::CanFrame> frames;
  std::size_t next = 0;
};

}  // namespace

TEST_GROUP(CanControllerBus) {
  Wire wire;
  Clock clock;
  NodeIds own = controller_ids(Layout::fd, kActuators);
  NodeIds of_plant = plant_ids(Layout::fd, kActuators);
  Wire::Node node{wire, own.subscriptions, own.senders};
  Wire::Node plant_node{wire, of_plant.subscriptions, of_plant.senders};
  Controller controller{node, clock, {Layout::fd, kActuators, 5.0, kControllerBusMillisecond}};
  PlantBus<Wire::Node, Clock> plant{plant_node, clock, {Layout::fd, kActuators, 1, 5.0, kControllerBusMillisecond}};
  hal::Command pistons;
};

TEST(CanControllerBus, WhatItCommandsIsWhatThePlantReceivesAndWhatThePlantReadsIsWhatItSees) {
  hal::Reading commands;
  hal::Reading reading;
  hal::Command received;
  for (std::uint64_t cycle = 0; cycle < 600; ++cycle) {
    for (std::size_t i = 0; i < kActuators; ++i) {
      commands.values[i] = 1e-4 * static_cast<double>(cycle % 100 + i);
      reading.values[i] = -1e-3 * static_cast<double>(i);
    }
    commands.sequence = reading.sequence = cycle;
    CHECK(controller.try_send_reading(commands));
    CHECK(plant.try_receive_command(received));
    CHECK(plant.try_send_reading(reading));
    CHECK(controller.try_receive_command(pistons));
    for (std::size_t i = 0; i < kActuators; ++i) {
      DOUBLES_EQUAL(commands.values[i], received.values[i], 5e-6);
      DOUBLES_EQUAL(reading.values[i], pistons.values[i], 1e-7);
    }
    UNSIGNED_LONGS_EQUAL(cycle, pistons.sequence);
  }
  UNSIGNED_LONGS_EQUAL(600, controller.readings(0).taken);
  UNSIGNED_LONGS_EQUAL(0, controller.lost_syncs());
}

TEST(CanControllerBus, ReadingIsHeldUntilThereIsANewOne) {
  hal::Reading reading;
  reading.values[0] = 0.01;
  CHECK(plant.try_send_reading(reading));
  CHECK(controller.try_receive_command(pistons));
  CHECK(!controller.try_receive_command(pistons));
  DOUBLES_EQUAL(0.01, pistons.values[0], 1e-9);
}

TEST(CanControllerBus, CommandBeyondItsSignalIsNotSent) {
  hal::Reading commands;
  commands.values[3] = 1.0;
  CHECK(!controller.try_send_reading(commands));
  UNSIGNED_LONGS_EQUAL(1, controller.unsayable());
}

TEST_GROUP(CanSyncSource) {
  ListedFrames frames;
  CanSyncSource<ListedFrames> source{frames};
  hal::Sync sync;
};

TEST(CanSyncSource, NewestSyncIsGivenAndTheOlderOnesAreCounted) {
  frames.add(254);
  frames.add(255);
  frames.add(0);
  CHECK(source.wait_for_sync(0, sync));
  LONGS_EQUAL(3 * kControllerBusMillisecond, sync.arrival_ns);
  UNSIGNED_LONGS_EQUAL(2, sync.superseded);
  CHECK(!source.wait_for_sync(0, sync));
}

TEST(CanSyncSource, DamagedOrRepeatedFrameIsNoSync) {
  frames.add(7, true);
  CHECK(!source.wait_for_sync(0, sync));
  frames.add(8);
  frames.add(8);
  CHECK(source.wait_for_sync(0, sync));
  LONGS_EQUAL(2 * kControllerBusMillisecond, sync.arrival_ns);
  UNSIGNED_LONGS_EQUAL(0, sync.superseded);
}

TEST_GROUP(CanBusLoad){};

TEST(CanBusLoad, ClassicLayoutFitsAMegabitAndNotHalfOfIt) {
  CHECK(bus_load(Layout::classic, 2, kControllerBusMillisecond, 1e6, 1e6) < hal::kLargestBusLoad);
  CHECK(bus_load(Layout::classic, 2, kControllerBusMillisecond, 500e3, 500e3) > hal::kLargestBusLoad);
  CHECK(bus_load(Layout::fd, 8, kControllerBusMillisecond, 1e6, 5e6) < hal::kLargestBusLoad);
  // The figures of docs/can-map.md.
  DOUBLES_EQUAL(0.471, bus_load(Layout::classic, 2, kControllerBusMillisecond, 1e6, 1e6), 5e-4);
  DOUBLES_EQUAL(0.661, bus_load(Layout::classic_split, 2, kControllerBusMillisecond, 1e6, 1e6), 5e-4);
  DOUBLES_EQUAL(0.361, bus_load(Layout::fd, 8, kControllerBusMillisecond, 1e6, 5e6), 5e-4);
  DOUBLES_EQUAL(0.467, bus_load(Layout::fd_split, 8, kControllerBusMillisecond, 1e6, 5e6), 5e-4);
  const double strings = 2.0 * hal::longest_classic_frame(8, 1e6) / 4e-3;
  DOUBLES_EQUAL(bus_load(Layout::classic, 2, kControllerBusMillisecond, 1e6, 1e6) + strings,
                bus_load(Layout::classic, 2, kControllerBusMillisecond, 1e6, 1e6, {.strings = true}), 1e-12);
  // Load pressures once a period, however often the map says.
  const double pressures = hal::longest_classic_frame(8, 1e6) / 2e-3;
  DOUBLES_EQUAL(bus_load(Layout::classic_split, 2, 2 * kControllerBusMillisecond, 1e6, 1e6) + pressures,
                bus_load(Layout::classic_split, 2, 2 * kControllerBusMillisecond, 1e6, 1e6, {.load_pressure = true}), 1e-12);
  DOUBLES_EQUAL(0.796, bus_load(Layout::classic_split, 2, kControllerBusMillisecond, 1e6, 1e6, {.load_pressure = true}),
                5e-4);
  DOUBLES_EQUAL(0.606, bus_load(Layout::classic, 2, kControllerBusMillisecond, 1e6, 1e6, {.load_pressure = true}), 5e-4);
  DOUBLES_EQUAL(0.499, bus_load(Layout::fd, 8, kControllerBusMillisecond, 1e6, 5e6, {.load_pressure = true}), 5e-4);
  DOUBLES_EQUAL(0.604, bus_load(Layout::fd_split, 8, kControllerBusMillisecond, 1e6, 5e6, {.load_pressure = true}), 5e-4);
}

}  // namespace hotfire::firmware::can
