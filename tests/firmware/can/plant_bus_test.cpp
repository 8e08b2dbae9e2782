// SPDX-License-Identifier: Apache-2.0
#include "tests/firmware/can/plant_world.hpp"

namespace hotfire::firmware::can {
namespace {

using test_plant::Bus;
using test_plant::kMillisecond;
using test_plant::Wire;
using test_plant::World;
static_assert(hal::PlantBus<Bus>);

/// The same with another plant, which is asked for its load pressures, value 2 of its actuators, and one who listens to
/// them.
struct Pressured : World {
  explicit Pressured(Layout frames) : World(frames, most_actuators(frames), 3), pressures(load_pressure_message(frames)) {
    for (std::size_t i = 0; i < actuators; ++i) {
      reading.values[3 * i + 2] = (i % 2 == 0 ? 1e7 : -1e7) * static_cast<double>(i + 1);
    }
  }

  bool anything_heard() {
    listener.receive(0);
    plant.receive(0);
    return listener.mailbox(0).fresh;
  }

  /// Whether the load pressures of a cycle are on the bus; if a reading cannot be said, that is told.
  bool heard() {
    CHECK_EQUAL(asked.try_send_reading(reading), asked.unsayable() == 0);
    ++reading.sequence;
    return anything_heard();
  }

  void check(std::uint8_t number) const {
    std::array<double, 32> values{};
    std::uint8_t counter = 0;
    CHECK(decode(pressures, listener.mailbox(0).frame, values, counter) == Decoding::good);
    BYTES_EQUAL(number, counter);
    for (std::size_t i = 0; i < actuators; ++i) {
      DOUBLES_EQUAL(reading.values[3 * i + 2], values[i], 0.0);
    }
  }

  const Message& pressures;
  hal::Reading reading;
  const std::array<hal::CanSubscription, 1> listened{{{id_of(pressures), pressures.fd}}};
  Wire::Node listener{wire, listened, {}};
  Wire::Node plant{wire, {}, plant_ids(layout, actuators, {.load_pressure = true}).senders};
  Bus asked{plant, clock, {.layout = layout, .actuators = actuators, .channels = 3, .load_pressure = 2}};
};

/// With a command in each of so many milliseconds the plant still follows; then it does not, and says so, until a heartbeat.
void expect_unfollowed_after(World& world, std::int64_t milliseconds, std::uint8_t heartbeat_counter) {
  DOUBLES_EQUAL(0.01, world.commanded_for(milliseconds), 1e-12);
  DOUBLES_EQUAL(0.0, world.commanded_for(1), 0.0);
  DOUBLES_EQUAL(38.0, world.said_fault(), 0.0);
  DOUBLES_EQUAL(0.0, world.commanded_for(300), 0.0);
  world.beat(heartbeat_counter);
  DOUBLES_EQUAL(0.01, world.commanded_for(1), 1e-12);
  DOUBLES_EQUAL(0.0, world.said_fault(), 0.0);
}

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

TEST(CanPlantBus, TwoControllersMoveNothingAndStatusSaysSoUntilOneOfThemIsLeft) {
  for (std::size_t number = 0; number < kLayouts.size(); ++number) {
    const auto layout = static_cast<Layout>(number);
    for (const std::uint8_t other : std::array<std::uint8_t, 3>{10, 9, 190}) {
      World world{layout, most_actuators(layout)};
      world.send(10);
      CHECK(world.take());
      world.send(other, 0.02);
      CHECK(world.take());
      DOUBLES_EQUAL(0.0, world.command.values[0], 0.0);
      world.send(11);
      CHECK(!world.take());
      DOUBLES_EQUAL(36.0, world.said_fault(), 0.0);
      world.clock.advance_ns(Bus::kSecondSenderHoldNs);
      world.send(12);
      CHECK(world.take());
      DOUBLES_EQUAL(0.01, world.command.values[0], 1e-12);
      DOUBLES_EQUAL(0.0, world.said_fault(), 0.0);
    }
  }
}

TEST(CanPlantBus, SecondControllerIsFoundOutThoughTheFramesOfTheFirstOvertakeIts) {
  fd.send(10);
  CHECK(fd.take());
  fd.send(10, 0.02);
  fd.send(11);
  CHECK(fd.take());
  DOUBLES_EQUAL(0.0, fd.command.values[0], 0.0);
  UNSIGNED_LONGS_EQUAL(1, fd.bus.commands().repeated);
}

TEST(CanPlantBus, AnotherPlantOnItsBusMovesNothing) {
  Wire::Node other{classic.wire, {}, plant_ids(Layout::classic, 2).senders};
  classic.send(10);
  CHECK(classic.take());
  hal::CanFrame frame;
  CHECK(encode(piston_1::kMessage, std::array{0.0, 0.0}, 1, frame));
  CHECK(other.try_send(frame) == hal::CanSend::taken);
  CHECK(classic.take());
  DOUBLES_EQUAL(0.0, classic.command.values[0], 0.0);
}

TEST(CanPlantBus, ControllerWhoseHeartbeatHasStoppedGetsNoCurrentUntilItIsBack) {
  classic.beat(0);
  CHECK(!classic.take());
  expect_unfollowed_after(classic, 50, 77);
}

TEST(CanPlantBus, ControllerThatNeverSendsAHeartbeatIsFollowedForTheAgeLimitOnlyAndAgainOnceItDoes) {
  World world{Layout::classic, 2, 3, false};
  world.clock.advance_ns(1000 * kMillisecond);
  expect_unfollowed_after(world, 51, 0);
}

TEST(CanPlantBus, ControllerThatNeverSendsAHeartbeatIsFollowedIfThatIsAllowed) {
  classic.clock.advance_ns(1000 * kMillisecond);
  DOUBLES_EQUAL(0.01, classic.commanded_for(300), 1e-12);
  DOUBLES_EQUAL(0.0, classic.said_fault(), 0.0);
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
  for (std::size_t number = 0; number < kLayouts.size(); ++number) {
    const auto layout = static_cast<Layout>(number);
    const std::size_t actuators = most_actuators(layout);
    World owned{layout, actuators, 3};
    World* const world = &owned;
    hal::Reading reading;
    for (std::size_t i = 0; i < actuators; ++i) {
      reading.values[3 * i] = 0.01 * static_cast<double>(i + 1);
    }
    reading.sequence = 300;
    reading.command_sequence = 299;
    CHECK(world->bus.try_send_reading(reading));
    world->controller.receive(0);
    for (std::size_t i = 0; i < actuators; ++i) {
      for (std::size_t redundant = 0; redundant < kRedundantReadings; ++redundant) {
        const PistonPlace place = place_of_piston(layout, i, redundant);
        std::array<double, 32> values{};
        std::uint8_t counter = 0;
        CHECK(decode(reading_message(layout, place.message), world->controller.mailbox(place.message).frame, values,
                     counter) == Decoding::good);
        DOUBLES_EQUAL(reading.values[3 * i], values[place.value], 1e-12);
        UNSIGNED_LONGS_EQUAL(300 % 256, counter);
        CHECK(!has_echo(layout) || values[kEchoPlace] == 299 % 256);
      }
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

TEST(CanPlantBus, LoadPressuresAreSentEveryCycleByAPlantThatIsAskedToAndByNoOther) {
  for (std::size_t number = 0; number < kLayouts.size(); ++number) {
    Pressured world{static_cast<Layout>(number)};
    for (int cycle = 0; cycle < 10; ++cycle) {
      CHECK(world.heard());
      world.check(static_cast<std::uint8_t>(cycle));
    }
    CHECK(world.bus.try_send_reading(world.reading));
    CHECK(!world.anything_heard());
  }
}

TEST(CanPlantBus, LoadPressuresOfSensorsThatSpeakGoOnAndOneThatCannotBeSaidIsDroppedAndCounted) {
  for (std::size_t number = 0; number < kLayouts.size(); ++number) {
    Pressured world{static_cast<Layout>(number)};
    for (std::size_t i = 0; i < world.actuators; ++i) {
      world.reading.missing |= 1U << (3 * i + 2);
      CHECK_EQUAL(i + 1 < world.actuators, world.heard());
    }
    world.reading.missing = 0;
    world.reading.values[2] = 8.1e7;
    CHECK(!world.heard());
    UNSIGNED_LONGS_EQUAL(1, world.asked.unsayable());
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
