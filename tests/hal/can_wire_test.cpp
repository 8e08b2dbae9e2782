// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/can_wire.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/support/allocation_guard.hpp"

namespace hotfire::hal {
namespace {

constexpr CanId kCommand{0x100, false};
constexpr CanId kReading{0x200, false};
constexpr std::array<CanSubscription, 1> kCommands{{{kCommand, false, 5'000'000}}};
constexpr std::array<CanSubscription, 1> kReadings{{{kReading, false, 5'000'000}}};

CanFrame frame(const CanId& id, std::uint8_t first) {
  CanFrame made;
  made.id = id;
  made.length = 8;
  made.data[0] = first;
  return made;
}

}  // namespace

TEST_GROUP(CanWire) {
  sim::CanWire wire;
  sim::CanWire::Node plant{wire, kCommands, std::array{kReading}};
  sim::CanWire::Node controller{wire, kReadings, std::array{kCommand}};

  /// The controller sends these, each after the one before is known to be out.
  void send(std::initializer_list<std::uint8_t> values) {
    for (const std::uint8_t value : values) {
      CHECK(controller.try_send(frame(kCommand, value)) == CanSend::taken);
      controller.receive(0);
    }
  }
};

TEST(CanWire, NewestFrameIsKeptAndOlderOnesAreCountedAsSuperseded) {
  send({1, 2, 3});
  plant.receive(7);
  BYTES_EQUAL(3, plant.mailbox(0).frame.data[0]);
  UNSIGNED_LONGS_EQUAL(3, plant.mailbox(0).received);
  UNSIGNED_LONGS_EQUAL(2, plant.mailbox(0).superseded);
  CHECK(plant.mailbox(0).fresh);
  plant.receive(8);
  CHECK(!plant.mailbox(0).fresh);
  UNSIGNED_LONGS_EQUAL(2, plant.counters().superseded);
}

TEST(CanWire, FrameIsInTimeUpToItsAgeLimitAndNoneIsNeverInTime) {
  CHECK(!plant.in_time(0, 0));
  send({1});
  plant.receive(1'000'000);
  CHECK(plant.in_time(0, 6'000'000));
  CHECK(!plant.in_time(0, 6'000'001));
}

TEST(CanWire, FrameOfTheOtherFormatIsNotTaken) {
  CanFrame fd = frame(kCommand, 1);
  fd.fd = true;
  CHECK(controller.try_send(fd) == CanSend::taken);
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(0, plant.mailbox(0).received);
  UNSIGNED_LONGS_EQUAL(1, plant.counters().foreign);
}

TEST(CanWire, SecondFrameOfAnIdIsRefusedUntilTheFirstIsOut) {
  wire.hold();
  CHECK(controller.try_send(frame(kCommand, 1)) == CanSend::taken);
  controller.receive(0);
  CHECK(controller.try_send(frame(kCommand, 2)) == CanSend::pending);
  UNSIGNED_LONGS_EQUAL(1, controller.counters().pending);
  wire.release();
  controller.receive(0);
  CHECK(controller.try_send(frame(kCommand, 3)) == CanSend::taken);
}

TEST(CanWire, WhatIsHeldWhenANodeStopsNeverLeaves) {
  wire.hold();
  CHECK(controller.try_send(frame(kCommand, 1)) == CanSend::taken);
  CHECK(controller.stop());
  wire.release();
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(0, plant.mailbox(0).received);
  CHECK(controller.try_send(frame(kCommand, 2)) == CanSend::unusable);
}

TEST(CanWire, BusOffRefusesFramesUntilRearmedEvenIfTheBusIsBack) {
  wire.set_bus_off(true);
  controller.receive(0);
  CHECK(controller.state() == CanState::bus_off);
  CHECK(!controller.rearm());
  wire.set_bus_off(false);
  controller.receive(0);
  CHECK(controller.state() == CanState::bus_off);
  CHECK(controller.try_send(frame(kCommand, 1)) == CanSend::unusable);
  CHECK(controller.rearm());
  send({2});
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(1, plant.mailbox(0).received);
}

TEST(CanWire, DownIsSeenOnSendingAndRearmForgetsWhatArrivedBefore) {
  send({1});
  plant.receive(0);
  wire.set_down(true);
  CHECK(controller.try_send(frame(kCommand, 2)) == CanSend::unusable);
  CHECK(controller.state() == CanState::down);
  plant.receive(0);
  wire.set_down(false);
  CHECK(plant.rearm());
  UNSIGNED_LONGS_EQUAL(0, plant.mailbox(0).received);
}

TEST(CanWire, FullQueueDropsTheFrameAndCountsIt) {
  wire.set_queue_full(true);
  CHECK(controller.try_send(frame(kCommand, 1)) == CanSend::queue_full);
  wire.set_queue_full(false);
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(0, plant.mailbox(0).received);
  UNSIGNED_LONGS_EQUAL(1, controller.counters().queue_full);
  send({2});
}

TEST(CanWire, IdThatWasNotNamedAtSetUpIsNotSent) { CHECK(controller.try_send(frame(kReading, 1)) == CanSend::unusable); }

TEST(CanWire, WhatANodeDoesNotFetchIsDroppedAndCounted) {
  constexpr std::size_t kSent = sim::CanWire::kMaxFrames + 10;
  for (std::size_t i = 0; i < kSent; ++i) {
    send({1});
  }
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(kSent, plant.mailbox(0).received + plant.counters().dropped);
  UNSIGNED_LONGS_EQUAL(10, plant.counters().dropped);
}

TEST(CanWire, ReceivingAndSendingAllocateNothing) {
  const test::AllocationGuard guard;
  send({1, 2});
  plant.receive(0);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
}

}  // namespace hotfire::hal
