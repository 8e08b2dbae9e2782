// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace hotfire::hal {

inline constexpr std::size_t kMaxActuators = 8;
inline constexpr std::size_t kMaxReadings = 3 * kMaxActuators;
inline constexpr std::size_t kMaxStrings = 2 * kMaxActuators;

/// The commands of a controller to the plant: one value for each actuator, in the plant's SI unit.
struct Command {
  std::array<double, kMaxActuators> values{};
  std::uint64_t sequence = 0;  ///< counted by the sender
};

/// The readings of the plant's sensors, actuator after actuator.
struct Reading {
  std::array<double, kMaxReadings> values{};
  std::size_t count = 0;                      ///< how many of `values` are used
  std::array<double, kMaxStrings> strings{};  ///< of string potentiometers, engine after engine [m]
  std::size_t string_count = 0;
  std::uint32_t missing = 0;           ///< bit i: `values[i]` is not sent, its sensor is silent
  std::uint64_t sequence = 0;          ///< number of the plant's cycle
  std::uint64_t command_sequence = 0;  ///< the command this reading answers
};

/// The plant's side of the wire to a controller.
///
/// - `try_receive_command(command)`: the newest command since the last call; older ones are dropped. False, with `command`
///   unchanged, if none has arrived. Never blocks.
/// - `try_send_reading(reading)`: gives the reading to the wire now, or drops it and returns false. Never blocks, never
///   queues, never retries: the next cycle has a newer one.
///
/// Both without allocation, lock or exception.
template <class B>
concept PlantBus = requires(B& bus, Command& command, const Reading& reading) {
  { bus.try_receive_command(command) }
  noexcept->std::same_as<bool>;
  { bus.try_send_reading(reading) }
  noexcept->std::same_as<bool>;
};

}  // namespace hotfire::hal
