#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/can/can_map.hpp"
#include "firmware/can/codec.hpp"
#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware::can {

/// One actuator of the classic layout.
struct PlantBusSettings {
  unsigned actuator = 1;             ///< 1 or 2
  double command_per_current = 1.0;  ///< [rad/A], or the plant's command unit per ampere
};

/// What a plant's bus has counted beside what its CAN bus counts.
struct PlantBusCounters {
  std::uint64_t commands = 0;   ///< taken
  std::uint64_t repeated = 0;   ///< with the counter of the one before, not taken
  std::uint64_t skipped = 0;    ///< counters never seen: lost on the way, or superseded
  std::uint64_t backward = 0;   ///< with a counter of the past, not taken
  std::uint64_t refused = 0;    ///< wrong length, check or value
  std::uint64_t unsayable = 0;  ///< readings beyond what their signal can carry, not sent
};

/// The id that a plant listens to, and the one it sends.
constexpr hal::CanSubscription command_subscription() noexcept { return {{servovalve_command::kMessage.id, false}, false}; }
constexpr hal::CanId reading_id(const PlantBusSettings& settings) noexcept {
  return {settings.actuator == 1 ? piston_1::kMessage.id : piston_2::kMessage.id, false};
}

/// The plant's side of a CAN bus (`hal::PlantBus`), for one actuator: takes SERVOVALVE_COMMAND, sends PISTON_1 or PISTON_2
/// with the first value of a reading as both of its redundant readings. `Bus` subscribes to `command_subscription()` alone
/// and sends `reading_id()`.
///
/// A command counts as new only if its counter is ahead of the last one's by less than half of 256: a frame that is
/// repeated, or comes late from a gateway's queue, moves nothing. `Command::sequence` is that counter, carried on beyond
/// 256.
template <hal::CanBus Bus, hal::Clock Clock>
class PlantBus {
 public:
  PlantBus(Bus& bus, Clock& clock, const PlantBusSettings& settings) noexcept
      : bus_(bus), clock_(clock), settings_(settings) {}

  bool try_receive_command(hal::Command& command) noexcept {
    bus_.receive(clock_.now_ns());
    const hal::CanMailbox& box = bus_.mailbox(0);
    if (!box.fresh) {
      return false;
    }
    std::array<double, servovalve_command::kSignals.size()> currents{};
    std::uint8_t counter = 0;
    if (decode(servovalve_command::kMessage, box.frame, currents, counter) != Decoding::good) {
      ++counters_.refused;
      return false;
    }
    if (!is_new(counter)) {
      return false;
    }
    command.values.fill(0.0);
    command.values[0] = settings_.command_per_current * currents[settings_.actuator - 1];
    command.sequence = sequence_;
    ++counters_.commands;
    return true;
  }

  bool try_send_reading(const hal::Reading& reading) noexcept {
    const Message& message = settings_.actuator == 1 ? piston_1::kMessage : piston_2::kMessage;
    hal::CanFrame frame;
    if (!encode(message, std::array{reading.values[0], reading.values[0]}, static_cast<std::uint8_t>(reading.sequence),
                frame)) {
      ++counters_.unsayable;
      return false;
    }
    return bus_.try_send(frame) == hal::CanSend::taken;
  }

  const PlantBusCounters& counters() const noexcept { return counters_; }

 private:
  bool is_new(std::uint8_t counter) noexcept {
    constexpr unsigned kHalf = 128;
    const auto ahead = static_cast<std::uint8_t>(counter - static_cast<std::uint8_t>(sequence_));
    if (counters_.commands == 0) {
      sequence_ = counter;
      return true;
    }
    if (ahead == 0 || ahead >= kHalf) {
      ++(ahead == 0 ? counters_.repeated : counters_.backward);
      return false;
    }
    counters_.skipped += ahead - 1U;
    sequence_ += ahead;
    return true;
  }

  Bus& bus_;
  Clock& clock_;
  PlantBusSettings settings_;
  std::uint64_t sequence_ = 0;
  PlantBusCounters counters_;
};

}  // namespace hotfire::firmware::can
