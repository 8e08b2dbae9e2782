// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>

#include <array>
#include <vector>

#include "firmware/can/plant_bus.hpp"
#include "hal/sim/can_wire.hpp"
#include "hal/sim/manual_clock.hpp"

namespace hotfire::firmware::can::test_plant {

using Wire = hal::sim::CanWire;
using Bus = PlantBus<Wire::Node, hal::sim::ManualClock>;

constexpr std::int64_t kMillisecond = 1'000'000;

/// A plant's bus of a layout, and a controller's node.
struct World {
  World(Layout frames, std::size_t plants, std::size_t channels = 1, bool heartbeat_optional = true)
      : layout(frames),
        actuators(plants),
        bus(node, clock,
            {frames, plants, channels, 5.0, kMillisecond, 20 * kMillisecond, 50 * kMillisecond, nullptr, std::nullopt,
             heartbeat_optional}),
        node(wire, plant_ids(frames, plants).subscriptions, plant_ids(frames, plants, {true, true}).senders),
        controller(wire, heard(frames, plants), controller_ids(frames, plants).senders),
        message(command_message(frames)) {}

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

  /// The value of the first actuator's command after so many cycles with a command in each.
  double commanded_for(std::int64_t milliseconds) {
    for (std::int64_t i = 0; i < milliseconds; ++i) {
      clock.advance_ns(kMillisecond);
      send(commands++);
      take();
    }
    return command.values[0];
  }

  void beat(std::uint8_t counter) {
    hal::CanFrame frame;
    CHECK(encode(heartbeat::kMessage, std::array{1.0, 2.0}, counter, frame));
    CHECK(controller.try_send(frame) == hal::CanSend::taken);
    controller.receive(clock.now_ns());
  }

  /// The number of the fault in the next STATUS frame.
  double said_fault() {
    for (int i = 0; i < 101; ++i) {
      bus.try_send_reading({});
      controller.receive(clock.now_ns());
      // What the plant has sent is known to be out once it has looked.
      node.receive(clock.now_ns());
      const hal::CanMailbox& box = controller.mailbox(reading_messages(layout, actuators));
      if (box.fresh) {
        std::array<double, 32> values{};
        std::uint8_t counter = 0;
        CHECK(decode(status::kMessage, box.frame, values, counter) == Decoding::good);
        return values[status::fault];
      }
    }
    return -1.0;
  }

  Layout layout;
  std::size_t actuators;
  Wire wire;
  hal::sim::ManualClock clock;
  Bus bus;
  Wire::Node node;
  Wire::Node controller;
  const Message& message;
  hal::Command command;
  std::uint8_t commands = 0;  ///< counter of the next one of commanded_for
};

}  // namespace hotfire::firmware::can::test_plant
