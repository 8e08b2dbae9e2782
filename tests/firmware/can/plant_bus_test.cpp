#include "firmware/can/plant_bus.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/sim/can_wire.hpp"
#include "hal/sim/manual_clock.hpp"

namespace hotfire::firmware::can {
namespace {

using Wire = hal::sim::CanWire;
using Bus = PlantBus<Wire::Node, hal::sim::ManualClock>;
static_assert(hal::PlantBus<Bus>);

constexpr PlantBusSettings kSettings{2, 5.0};
constexpr hal::CanId kCommandId{servovalve_command::kMessage.id, false};

}  // namespace

TEST_GROUP(CanPlantBus) {
  Wire wire;
  hal::sim::ManualClock clock;
  Wire::Node node{wire, std::array{command_subscription()}, std::array{reading_id(kSettings)}};
  Wire::Node controller{wire, std::array{hal::CanSubscription{reading_id(kSettings)}}, std::array{kCommandId}};
  Bus bus{node, clock, kSettings};
  hal::Command command;

  void send(std::uint8_t counter, double current) {
    hal::CanFrame frame;
    CHECK(encode(servovalve_command::kMessage, std::array{-current, current}, counter, frame));
    CHECK(controller.try_send(frame) == hal::CanSend::taken);
    controller.receive(0);
  }
};

TEST(CanPlantBus, CommandIsTheCurrentOfItsActuatorInThePlantsUnit) {
  CHECK(!bus.try_receive_command(command));
  send(7, 0.002);
  CHECK(bus.try_receive_command(command));
  DOUBLES_EQUAL(0.01, command.values[0], 1e-12);
  UNSIGNED_LONGS_EQUAL(7, command.sequence);
  CHECK(!bus.try_receive_command(command));
}

TEST(CanPlantBus, SequenceGoesOnBeyondTheCounterAndSkippedOnesAreCounted) {
  for (unsigned i = 0; i < 600; ++i) {
    send(static_cast<std::uint8_t>(i), 0.0);
    CHECK(bus.try_receive_command(command));
    UNSIGNED_LONGS_EQUAL(i, command.sequence);
  }
  send(static_cast<std::uint8_t>(603), 0.0);
  CHECK(bus.try_receive_command(command));
  UNSIGNED_LONGS_EQUAL(603, command.sequence);
  UNSIGNED_LONGS_EQUAL(3, bus.counters().skipped);
}

TEST(CanPlantBus, RepeatedOrLateCommandMovesNothing) {
  send(10, 0.001);
  CHECK(bus.try_receive_command(command));
  send(10, 0.03);
  CHECK(!bus.try_receive_command(command));
  send(9, 0.03);
  CHECK(!bus.try_receive_command(command));
  DOUBLES_EQUAL(0.005, command.values[0], 1e-12);
  UNSIGNED_LONGS_EQUAL(1, bus.counters().repeated);
  UNSIGNED_LONGS_EQUAL(1, bus.counters().backward);
}

TEST(CanPlantBus, DamagedCommandMovesNothingAndIsCounted) {
  hal::CanFrame frame;
  CHECK(encode(servovalve_command::kMessage, std::array{0.0, 0.001}, 0, frame));
  frame.data[4] ^= 1;
  CHECK(controller.try_send(frame) == hal::CanSend::taken);
  CHECK(!bus.try_receive_command(command));
  UNSIGNED_LONGS_EQUAL(1, bus.counters().refused);
}

TEST(CanPlantBus, ReadingCarriesThePistonTwiceUnderTheNumberOfItsCycle) {
  hal::Reading reading;
  reading.values[0] = 0.0123;
  reading.count = 3;
  reading.sequence = 300;
  CHECK(bus.try_send_reading(reading));
  controller.receive(0);
  std::array<double, 2> pistons{};
  std::uint8_t counter = 0;
  CHECK(decode(piston_2::kMessage, controller.mailbox(0).frame, pistons, counter) == Decoding::good);
  DOUBLES_EQUAL(0.0123, pistons[piston_2::piston_a], 1e-12);
  DOUBLES_EQUAL(0.0123, pistons[piston_2::piston_b], 1e-12);
  UNSIGNED_LONGS_EQUAL(300 % 256, counter);
}

TEST(CanPlantBus, ReadingThatCannotBeSaidOrSentIsDropped) {
  hal::Reading reading;
  reading.values[0] = 2.0;
  CHECK(!bus.try_send_reading(reading));
  UNSIGNED_LONGS_EQUAL(1, bus.counters().unsayable);
  reading.values[0] = 0.0;
  wire.set_queue_full(true);
  CHECK(!bus.try_send_reading(reading));
}

}  // namespace hotfire::firmware::can
