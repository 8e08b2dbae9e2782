#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/can/can_map.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// Which frames carry commands and readings (docs/can-map.md). `classic`: one engine of two actuators. `fd`: eight.
enum class Layout : std::uint8_t { classic, fd };
inline constexpr std::array<std::string_view, 2> kLayouts{"classic", "fd"};

constexpr std::size_t most_actuators(Layout layout) noexcept {
  return layout == Layout::classic ? servovalve_command::kSignals.size() : servovalve_command_fd::kSignals.size();
}

/// The layout with the shortest frames that have room for so many actuators.
constexpr Layout smallest_layout(std::size_t actuators) noexcept {
  return actuators <= most_actuators(Layout::classic) ? Layout::classic : Layout::fd;
}

constexpr const Message& command_message(Layout layout) noexcept {
  return layout == Layout::classic ? servovalve_command::kMessage : servovalve_command_fd::kMessage;
}

/// Messages that carry the readings of so many actuators.
constexpr std::size_t reading_messages(Layout layout, std::size_t actuators) noexcept {
  return layout == Layout::classic ? actuators : 1;
}

constexpr const Message& reading_message(Layout layout, std::size_t which) noexcept {
  return layout == Layout::fd ? pistons_fd::kMessage : which == 0 ? piston_1::kMessage : piston_2::kMessage;
}

/// Messages that carry the readings of string potentiometers: four of one engine, or sixteen of four.
constexpr std::size_t string_messages(Layout layout) noexcept { return layout == Layout::classic ? 2 : 1; }

constexpr const Message& string_message(Layout layout, std::size_t which) noexcept {
  return layout == Layout::fd ? strings_fd::kMessage : which == 0 ? strings_12::kMessage : strings_34::kMessage;
}

/// Where the two redundant readings of an actuator stand: the message, and the first of its two values.
struct PistonPlace {
  std::size_t message;
  std::size_t value;
};
constexpr PistonPlace place_of_piston(Layout layout, std::size_t actuator) noexcept {
  return layout == Layout::classic ? PistonPlace{actuator, piston_1::piston_a}
                                   : PistonPlace{0, pistons_fd::piston_1_a + 2 * actuator};
}

constexpr hal::CanId id_of(const Message& message) noexcept { return {message.id, false}; }

/// What a node of the bus listens to and sends; its mailboxes are in the order of `subscriptions`.
struct NodeIds {
  std::vector<hal::CanSubscription> subscriptions;
  std::vector<hal::CanId> senders;
};

/// Of a plant: mailbox 0 is the command.
inline NodeIds plant_ids(Layout layout, std::size_t actuators, bool strings = false) {
  NodeIds ids{{{id_of(command_message(layout)), command_message(layout).fd}}, {id_of(status::kMessage)}};
  for (std::size_t i = 0; i < reading_messages(layout, actuators); ++i) {
    ids.senders.push_back(id_of(reading_message(layout, i)));
  }
  for (std::size_t i = 0; strings && i < string_messages(layout); ++i) {
    ids.senders.push_back(id_of(string_message(layout, i)));
  }
  return ids;
}

/// Of a controller: mailbox i is reading message i.
inline NodeIds controller_ids(Layout layout, std::size_t actuators) {
  NodeIds ids{{}, {id_of(sync::kMessage), id_of(command_message(layout)), id_of(heartbeat::kMessage)}};
  for (std::size_t i = 0; i < reading_messages(layout, actuators); ++i) {
    const Message& message = reading_message(layout, i);
    ids.subscriptions.push_back({id_of(message), message.fd});
  }
  return ids;
}

}  // namespace hotfire::firmware::can
