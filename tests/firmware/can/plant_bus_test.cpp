#include "firmware/can/plant_bus.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/sim/can_wire.hpp"
#include "hal/sim/manual_clock.hpp"

namespace hotfire::firmware::can {
namespace {

using Wire = hal::sim::CanWire;
using Bus = PlantBus<Wire::Node, hal::sim::ManualClock>;
static_assert(hal::PlantBus<Bus>);

constexpr std::int64_t kMillisecond = 1'000'000;

/// A plant's bus of a layout, and a controller's node.
struct World {
  World(Layout layout, std::size_t actuators, std::size_t channels = 1)
      : bus(node, clock, {layout, actuators, channels, 5.0, kMillisecond, 20 * kMillisecond}),
        node(wire, plant_ids(layout, actuators).subscriptions, plant_ids(layout, actuators, true).senders),
        controller(wire, heard(layout, actuators), controller_ids(layout, actuators).senders),
        message(command_message(layout)) {}

  static std::vector<hal::CanSubscription> heard(Layout layout, std::size_t actuators) {
    std::vector<hal::CanSubscription> all = controller_ids(layout, actuators).subscriptions;
    all.push_back({id_of(status::kMessage)});
    return all;
  }

  hal::CanFrame framed(std::uint8_t counter, double first) const {
    std::array<double, hal::kMaxActuators> currents{};
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      currents[i] = first + 0.001 * static_cast<double>(i);
    }
    hal::CanFrame frame;
    CHECK(encode(message, std::span(currents).first(message.signals.size()), counter, frame));
    return frame;
  }

  void send(std::uint8_t counter, double first = 0.002) {
    CHECK(controller.try_send(framed(counter, first)) == hal::CanSend::taken);
    controller.receive(clock.now_ns());
  }

  bool take() { return bus.try_receive_command(command); }

  Wire wire;
  hal::sim::ManualClock clock;
  Bus bus;
  Wire::Node node;
  Wire::Node controller;
  const Message& message;
  hal::Command command;
};

}  // namespace

TEST_GROUP(CanPlantBus) {
  World classic{Layout::classic, 2, 3};
  World fd{Layout::fd, 8, 3};
};

TEST(CanPlantBus, CommandsAreTheCurrentsOfItsActuatorsInThePlantsUnit) {
  for (World* world : {&classic, &fd}) {
    CHECK(!world->take());
    world->send(7);
    CHECK(world->take());
    for (std::size_t i = 0; i < world->message.signals.size(); ++i) {
      DOUBLES_EQUAL(5.0 * (0.002 + 0.001 * static_cast<double>(i)), world->command.values[i], 1e-12);
    }
    UNSIGNED_LONGS_EQUAL(7, world->command.sequence);
    CHECK(!world->take());
  }
}

TEST(CanPlantBus, ServovalveWithoutAnActuatorOfThePlantIsLeftOut) {
  World one{Layout::classic, 1};
  one.send(0);
  CHECK(one.take());
  DOUBLES_EQUAL(0.01, one.command.values[0], 1e-12);
  DOUBLES_EQUAL(0.0, one.command.values[1], 0.0);
}

TEST(CanPlantBus, SequenceGoesOnBeyondTheCounterAndSkippedOnesAreCounted) {
  for (unsigned i = 0; i < 600; ++i) {
    fd.send(static_cast<std::uint8_t>(i));
    CHECK(fd.take());
    UNSIGNED_LONGS_EQUAL(i, fd.command.sequence);
  }
  fd.send(static_cast<std::uint8_t>(603));
  CHECK(fd.take());
  UNSIGNED_LONGS_EQUAL(603, fd.command.sequence);
  UNSIGNED_LONGS_EQUAL(3, fd.bus.commands().skipped);
}

TEST(CanPlantBus, RepeatedOrLateCommandMovesNothing) {
  classic.send(10);
  CHECK(classic.take());
  classic.send(10, 0.03);
  CHECK(!classic.take());
  classic.send(9, 0.03);
  CHECK(!classic.take());
  DOUBLES_EQUAL(0.01, classic.command.values[0], 1e-12);
  UNSIGNED_LONGS_EQUAL(1, classic.bus.commands().repeated);
  UNSIGNED_LONGS_EQUAL(1, classic.bus.commands().backward);
}

TEST(CanPlantBus, DamagedCommandMovesNothingAndIsCounted) {
  hal::CanFrame frame = fd.framed(0, 0.001);
  frame.data[4] ^= 1;
  CHECK(fd.controller.try_send(frame) == hal::CanSend::taken);
  CHECK(!fd.take());
  UNSIGNED_LONGS_EQUAL(1, fd.bus.commands().refused);
}

TEST(CanPlantBus, CommandBeyondItsAgeLimitGivesNoCurrentAndIsCounted) {
  classic.send(10);
  CHECK(classic.take());
  classic.clock.advance_ns(20 * kMillisecond);
  CHECK(!classic.take());
  DOUBLES_EQUAL(0.01, classic.command.values[0], 1e-12);
  classic.clock.advance_ns(1);
  CHECK(classic.take());
  DOUBLES_EQUAL(0.0, classic.command.values[0], 0.0);
  CHECK(!classic.take());
  UNSIGNED_LONGS_EQUAL(2, classic.bus.stale_cycles());
}

TEST(CanPlantBus, ControllerThatComesBackIsTakenWhateverItsCounter) {
  classic.send(200);
  CHECK(classic.take());
  classic.clock.advance_ns(21 * kMillisecond);
  CHECK(classic.take());
  classic.send(199);
  CHECK(classic.take());
  DOUBLES_EQUAL(0.01, classic.command.values[0], 1e-12);
  UNSIGNED_LONGS_EQUAL(0, classic.bus.commands().backward);
}

TEST(CanPlantBus, ReadingCarriesEveryPistonTwiceUnderTheNumberOfItsCycle) {
  for (World* world : {&classic, &fd}) {
    hal::Reading reading;
    const Layout layout = world == &classic ? Layout::classic : Layout::fd;
    const std::size_t actuators = most_actuators(layout);
    for (std::size_t i = 0; i < actuators; ++i) {
      reading.values[3 * i] = 0.01 * static_cast<double>(i + 1);
    }
    reading.sequence = 300;
    reading.command_sequence = 299;
    CHECK(world->bus.try_send_reading(reading));
    world->controller.receive(0);
    for (std::size_t i = 0; i < actuators; ++i) {
      const PistonPlace place = place_of_piston(layout, i);
      std::array<double, 32> values{};
      std::uint8_t counter = 0;
      CHECK(decode(reading_message(layout, place.message), world->controller.mailbox(place.message).frame, values,
                   counter) == Decoding::good);
      DOUBLES_EQUAL(reading.values[3 * i], values[place.value], 1e-12);
      DOUBLES_EQUAL(reading.values[3 * i], values[place.value + 1], 1e-12);
      UNSIGNED_LONGS_EQUAL(300 % 256, counter);
      CHECK(layout == Layout::classic || values[pistons_fd::command_counter] == 299 % 256);
    }
  }
}

TEST(CanPlantBus, ReadingOfASilentSensorIsNotSent) {
  hal::Reading reading;
  reading.missing = 1U << 3;
  CHECK(classic.bus.try_send_reading(reading));
  classic.controller.receive(0);
  CHECK(classic.controller.mailbox(0).fresh);
  CHECK(!classic.controller.mailbox(1).fresh);
}

TEST(CanPlantBus, StatusIsSentEveryHundredMilliseconds) {
  std::uint64_t seen = 0;
  for (int i = 0; i < 201; ++i) {
    classic.bus.try_send_reading({});
    classic.controller.receive(0);
    classic.take();
    seen += classic.controller.mailbox(2).fresh ? 1 : 0;
  }
  UNSIGNED_LONGS_EQUAL(3, seen);
}

TEST(CanPlantBus, StringPotentiometersAreSentEveryFourMillisecondsByAPlantThatHasThem) {
  for (const Layout layout : {Layout::classic, Layout::fd}) {
    World world{layout, most_actuators(layout), 3};
    std::vector<hal::CanSubscription> heard;
    for (std::size_t i = 0; i < string_messages(layout); ++i) {
      heard.push_back({id_of(string_message(layout, i)), string_message(layout, i).fd});
    }
    Wire::Node listener{world.wire, heard, {}};
    hal::Reading reading;
    for (std::size_t i = 0; i < hal::kMaxStrings; ++i) {
      reading.strings[i] = 0.001 * static_cast<double>(i + 1);
    }
    const auto seen = [&] {
      world.bus.try_send_reading(reading);
      world.controller.receive(0);
      world.take();
      listener.receive(0);
      return listener.mailbox(0).fresh;
    };
    CHECK(!seen());
    reading.string_count = layout == Layout::classic ? 4 : 16;
    for (int cycle = 0; cycle < 9; ++cycle) {
      const bool sent = seen();
      CHECK_EQUAL(cycle % 4 == 0, sent);
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < string_messages(layout); ++i) {
      std::array<double, hal::kMaxStrings> values{};
      std::uint8_t counter = 0;
      CHECK(decode(string_message(layout, i), listener.mailbox(i).frame, values, counter) == Decoding::good);
      UNSIGNED_LONGS_EQUAL(2, counter);
      for (std::size_t k = 0; k < string_message(layout, i).signals.size(); ++k) {
        DOUBLES_EQUAL(reading.strings[next++], values[k], 1e-12);
      }
    }
    UNSIGNED_LONGS_EQUAL(reading.string_count, next);
  }
}

TEST(CanPlantBus, ReadingThatCannotBeSaidOrSentIsDropped) {
  hal::Reading reading;
  reading.values[0] = 2.0;
  CHECK(!fd.bus.try_send_reading(reading));
  UNSIGNED_LONGS_EQUAL(1, fd.bus.unsayable());
  reading.values[0] = 0.0;
  fd.wire.set_queue_full(true);
  CHECK(!fd.bus.try_send_reading(reading));
}

}  // namespace hotfire::firmware::can
