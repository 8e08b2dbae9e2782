// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/can/can_map.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// The frames that carry commands and readings (docs/can-map.md). `classic`: one engine of two actuators. `fd`: eight
/// actuators. In a `split` layout the two redundant readings of an actuator come in separate frames from separate nodes. A
/// single node can therefore not make them agree.
enum class Layout : std::uint8_t { classic, fd, classic_split, fd_split };
inline constexpr std::array<std::string_view, 4> kLayouts{"classic", "fd", "classic-split", "fd-split"};

constexpr bool is_fd(Layout layout) noexcept { return layout == Layout::fd || layout == Layout::fd_split; }
constexpr bool is_split(Layout layout) noexcept { return layout == Layout::classic_split || layout == Layout::fd_split; }
/// Whether a reading contains the counter of the newest command of its node.
constexpr bool has_echo(Layout layout) noexcept { return layout != Layout::classic; }

constexpr std::size_t most_actuators(Layout layout) noexcept {
  return is_fd(layout) ? servovalve_command_fd::kSignals.size() : servovalve_command::kSignals.size();
}

/// The layout with the shortest frames that have room for so many actuators.
constexpr Layout smallest_layout(std::size_t actuators) noexcept {
  return actuators <= most_actuators(Layout::classic) ? Layout::classic : Layout::fd;
}

constexpr const Message& command_message(Layout layout) noexcept {
  return is_fd(layout) ? servovalve_command_fd::kMessage : servovalve_command::kMessage;
}

/// Messages that carry the readings of an actuator, at most.
inline constexpr std::size_t kMostReadingMessages = 4;
inline constexpr std::size_t kRedundantReadings = 2;

/// Messages that carry the readings of so many actuators.
constexpr std::size_t reading_messages(Layout layout, std::size_t actuators) noexcept {
  return (is_fd(layout) ? 1 : actuators) * (is_split(layout) ? kRedundantReadings : 1);
}

constexpr const Message& reading_message(Layout layout, std::size_t which) noexcept {
  constexpr std::array kClassic{&piston_1::kMessage, &piston_2::kMessage};
  constexpr std::array kClassicSplit{&piston_1_a::kMessage, &piston_1_b::kMessage, &piston_2_a::kMessage,
                                     &piston_2_b::kMessage};
  constexpr std::array kFdSplit{&pistons_a_fd::kMessage, &pistons_b_fd::kMessage};
  switch (layout) {
    case Layout::fd:
      return pistons_fd::kMessage;
    case Layout::classic_split:
      return *kClassicSplit[which];
    case Layout::fd_split:
      return *kFdSplit[which];
    case Layout::classic:
      break;
  }
  return *kClassic[which];
}

/// Messages that carry the readings of string potentiometers: four of one engine, or sixteen of four.
constexpr std::size_t string_messages(Layout layout) noexcept { return is_fd(layout) ? 1 : 2; }

constexpr const Message& string_message(Layout layout, std::size_t which) noexcept {
  return is_fd(layout) ? strings_fd::kMessage : which == 0 ? strings_12::kMessage : strings_34::kMessage;
}

/// The message that carries the load pressures of all actuators, in the order of its values.
constexpr const Message& load_pressure_message(Layout layout) noexcept {
  return is_fd(layout) ? load_pressures_fd::kMessage : load_pressures::kMessage;
}

/// What a plant sends in addition to its pistons.
struct MoreReadings {
  bool strings = false;
  bool load_pressure = false;
};

/// The place of one of the two redundant readings of an actuator: its message, and its value there.
struct PistonPlace {
  std::size_t message;
  std::size_t value;
};
constexpr PistonPlace place_of_piston(Layout layout, std::size_t actuator, std::size_t reading) noexcept {
  switch (layout) {
    case Layout::fd:
      return {0, pistons_fd::piston_1_a + 2 * actuator + reading};
    case Layout::classic_split:
      return {2 * actuator + reading, piston_1_a::piston};
    case Layout::fd_split:
      return {reading, pistons_a_fd::piston_1 + actuator};
    case Layout::classic:
      break;
  }
  return {actuator, piston_1::piston_a + reading};
}

/// Where a reading of a layout with an echo has the counter of the newest command that its node has.
constexpr std::size_t kEchoPlace = pistons_fd::command_counter;
static_assert(pistons_a_fd::command_counter == kEchoPlace && piston_1_a::command_counter == kEchoPlace);

constexpr hal::CanId id_of(const Message& message) noexcept { return {message.id, false}; }

/// The frames that a node receives and sends; its mailboxes are in the order of `subscriptions`.
struct NodeIds {
  std::vector<hal::CanSubscription> subscriptions;
  std::vector<hal::CanId> senders;
};

/// Of a plant: subscription 0 is the command, 1 the heartbeat.
inline NodeIds plant_ids(Layout layout, std::size_t actuators, MoreReadings more = {}) {
  NodeIds ids{{{id_of(command_message(layout)), command_message(layout).fd}, {id_of(heartbeat::kMessage)}},
              {id_of(status::kMessage)}};
  for (std::size_t i = 0; i < reading_messages(layout, actuators); ++i) {
    ids.senders.push_back(id_of(reading_message(layout, i)));
  }
  for (std::size_t i = 0; more.strings && i < string_messages(layout); ++i) {
    ids.senders.push_back(id_of(string_message(layout, i)));
  }
  if (more.load_pressure) {
    ids.senders.push_back(id_of(load_pressure_message(layout)));
  }
  return ids;
}

/// Of a controller: subscription i is reading message i. The last one is the load pressures, if the controller reads them.
inline NodeIds controller_ids(Layout layout, std::size_t actuators, bool load_pressure = false) {
  NodeIds ids{{}, {id_of(sync::kMessage), id_of(command_message(layout)), id_of(heartbeat::kMessage)}};
  for (std::size_t i = 0; i < reading_messages(layout, actuators); ++i) {
    const Message& message = reading_message(layout, i);
    ids.subscriptions.push_back({id_of(message), message.fd});
  }
  if (load_pressure) {
    ids.subscriptions.push_back({id_of(load_pressure_message(layout)), load_pressure_message(layout).fd});
  }
  return ids;
}

}  // namespace hotfire::firmware::can
