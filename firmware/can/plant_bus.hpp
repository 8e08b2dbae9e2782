#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "firmware/can/layout.hpp"
#include "firmware/can/message_follower.hpp"
#include "firmware/can/periodic_frame.hpp"
#include "firmware/interlock/faults.hpp"
#include "firmware/interlock/interlock.hpp"
#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware::can {

struct PlantBusSettings {
  Layout layout = Layout::classic;
  std::size_t actuators = 1;         ///< up to most_actuators(layout)
  std::size_t channels = 1;          ///< values of a reading that each of them has; the first is its piston [m]
  double command_per_current = 1.0;  ///< [rad/A], or the plant's command unit per ampere
  std::int64_t period_ns = 1'000'000;
  std::int64_t command_age_ns = std::numeric_limits<std::int64_t>::max();  ///< a command that is older counts as none
};

/// The plant's side of a CAN bus (`hal::PlantBus`): takes the command of its layout, sends the readings of its actuators,
/// the first value of each as both of its redundant ones, those of its string potentiometers if it has any, and its status.
/// `Bus` has the ids of `plant_ids`.
///
/// A servovalve that nobody commands gets no current: when the newest command is older than its age limit, the plant is
/// commanded zero, and the next frame is the first of a new series. What a played fault keeps from being sent is left out;
/// in the FD layout, whose frame is of all actuators, it is held, and the frame left out if none is left.
template <hal::CanBus Bus, hal::Clock Clock>
class PlantBus {
 public:
  PlantBus(Bus& bus, Clock& clock, const PlantBusSettings& settings) noexcept
      : bus_(bus),
        clock_(clock),
        settings_(settings),
        status_(status::kMessage, settings.period_ns),
        strings_(string_message(settings.layout, 0), settings.period_ns) {}

  bool try_receive_command(hal::Command& command) noexcept {
    const std::int64_t now = clock_.now_ns();
    bus_.receive(now);
    const hal::CanMailbox& box = bus_.mailbox(0);
    std::array<double, hal::kMaxActuators> currents{};
    const bool too_old = box.fresh && now - box.arrived_ns > settings_.command_age_ns;
    too_old_ += too_old ? 1 : 0;
    if (box.fresh && !too_old && commands_.take(command_message(settings_.layout), box.frame, currents)) {
      command.values.fill(0.0);
      for (std::size_t i = 0; i < settings_.actuators; ++i) {
        command.values[i] = settings_.command_per_current * currents[i];
      }
      command.sequence = commands_.sequence();
      arrived_ns_ = box.arrived_ns;
      commanded_ = true;
      stale_ = false;
      return true;
    }
    return is_first_stale_cycle(now) && clear(command);
  }

  bool try_send_reading(const hal::Reading& reading) noexcept {
    if (status_.is_due()) {
      const double superseded = static_cast<double>(bus_.counters().superseded % kCounts);
      status_.send(
          bus_, std::array{static_cast<double>(RigState::running), stale_ ? static_cast<double>(Fault::stale_command) : 0.0,
                           static_cast<double>(overruns_ % kCounts), superseded});
    }
    const bool taken = settings_.layout == Layout::classic ? send_classic(reading) : send_fd(reading);
    if (reading.string_count > 0 && strings_.is_due()) {
      send_strings(reading);
    }
    return taken;
  }

  /// A cycle of the loop has overrun.
  void note_overrun() noexcept { ++overruns_; }

  const MessageCounters& commands() const noexcept { return commands_.counters(); }
  /// Cycles without a command that is young enough, from the first command on.
  std::uint64_t stale_cycles() const noexcept { return stale_cycles_; }
  /// Commands that were too old when the loop came to look at them, not taken.
  std::uint64_t too_old() const noexcept { return too_old_; }
  /// Frames that were not sent because a reading is beyond what its signal can carry.
  std::uint64_t unsayable() const noexcept { return unsayable_; }

 private:
  static constexpr std::uint64_t kCounts = 65536;

  bool is_first_stale_cycle(std::int64_t now) noexcept {
    if (!commanded_ || now - arrived_ns_ <= settings_.command_age_ns) {
      return false;
    }
    ++stale_cycles_;
    const bool first = !stale_;
    stale_ = true;
    return first;
  }

  bool clear(hal::Command& command) noexcept {
    command.values.fill(0.0);
    commands_.forget();
    return true;
  }

  static bool is_missing(const hal::Reading& reading, std::size_t value) noexcept {
    return ((reading.missing >> value) & 1U) != 0;
  }

  bool send(const Message& message, std::span<const double> values, std::uint64_t counter) noexcept {
    hal::CanFrame frame;
    if (!encode(message, values, static_cast<std::uint8_t>(counter), frame)) {
      ++unsayable_;
      return false;
    }
    return bus_.try_send(frame) == hal::CanSend::taken;
  }

  bool send_classic(const hal::Reading& reading) noexcept {
    bool taken = true;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      const std::size_t value = i * settings_.channels;
      if (!is_missing(reading, value)) {
        const double piston = reading.values[value];
        taken = send(reading_message(Layout::classic, i), std::array{piston, piston}, reading.sequence) && taken;
      }
    }
    return taken;
  }

  bool send_fd(const hal::Reading& reading) noexcept {
    std::array<double, pistons_fd::kSignals.size()> values{};
    values[pistons_fd::command_counter] = static_cast<double>(static_cast<std::uint8_t>(reading.command_sequence));
    std::size_t missing = 0;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      const std::size_t place = place_of_piston(Layout::fd, i).value;
      values[place] = values[place + 1] = reading.values[i * settings_.channels];
      missing += is_missing(reading, i * settings_.channels) ? 1 : 0;
    }
    return missing == settings_.actuators || send(pistons_fd::kMessage, values, reading.sequence);
  }

  void send_strings(const hal::Reading& reading) noexcept {
    std::size_t first = 0;
    for (std::size_t i = 0; i < string_messages(settings_.layout); ++i) {
      const Message& message = string_message(settings_.layout, i);
      send(message, std::span(reading.strings).subspan(first, message.signals.size()), string_counter_);
      first += message.signals.size();
    }
    ++string_counter_;
  }

  Bus& bus_;
  Clock& clock_;
  PlantBusSettings settings_;
  MessageFollower commands_;
  PeriodicFrame status_;
  PeriodicFrame strings_;  ///< says when they are due
  std::uint8_t string_counter_ = 0;
  std::int64_t arrived_ns_ = 0;
  bool commanded_ = false;
  bool stale_ = false;
  std::uint64_t stale_cycles_ = 0;
  std::uint64_t too_old_ = 0;
  std::uint64_t unsayable_ = 0;
  std::uint64_t overruns_ = 0;
};

}  // namespace hotfire::firmware::can
