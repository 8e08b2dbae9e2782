// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/can/layout.hpp"
#include "firmware/can/message_follower.hpp"
#include "firmware/can/periodic_frame.hpp"
#include "firmware/interlock/interlock.hpp"
#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware::can {

struct ControllerBusSettings {
  Layout layout = Layout::classic;
  std::size_t actuators = 1;
  double command_per_current = 1.0;  ///< [rad/A]
  std::int64_t period_ns = 1'000'000;
  Authentication* authentication = nullptr;  ///< of commands and readings, if it is asked for
};

/// The controller's side of a CAN bus. For the loop it is a `hal::PlantBus` with exchanged roles. It receives the pistons
/// [m], each the mean of its two readings, and it sends the commands [rad]. `Bus` has the ids of `controller_ids`.
///
/// SYNC follows the command. A plant that is locked to SYNC therefore finds the command there. Its answer is read in the
/// next cycle.
template <hal::CanBus Bus, hal::Clock Clock>
class ControllerBus {
 public:
  ControllerBus(Bus& bus, Clock& clock, const ControllerBusSettings& settings) noexcept
      : bus_(bus),
        clock_(clock),
        settings_(settings),
        sync_(sync::kMessage, settings.period_ns),
        heartbeat_(heartbeat::kMessage, settings.period_ns) {
    for (MessageFollower& reading : readings_) {
      reading.require(settings.authentication);
    }
  }

  bool try_receive_command(hal::Command& pistons) noexcept {
    bus_.receive(clock_.now_ns());
    std::array<std::array<double, pistons_fd::kSignals.size()>, kMostMessages> values{};
    std::array<bool, kMostMessages> taken{};
    bool any = false;
    for (std::size_t i = 0; i < reading_messages(settings_.layout, settings_.actuators); ++i) {
      taken[i] = readings_[i].take_newest(reading_message(settings_.layout, i), bus_.arrivals(), i, values[i]).has_value();
      any = any || taken[i];
    }
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      for (std::size_t reading = 0; reading < kRedundantReadings; ++reading) {
        const PistonPlace place = place_of_piston(settings_.layout, i, reading);
        if (taken[place.message]) {
          pistons_[i][reading] = values[place.message][place.value];
        }
      }
      pistons.values[i] = 0.5 * (pistons_[i][0] + pistons_[i][1]);
    }
    pistons.sequence = readings_[0].sequence();
    return any;
  }

  bool try_send_reading(const hal::Reading& commands) noexcept {
    if (heartbeat_.is_due()) {
      heartbeat_.send(bus_, std::array{kNode, static_cast<double>(RigState::running)});
    }
    std::array<double, hal::kMaxActuators> currents{};
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      currents[i] = commands.values[i] / settings_.command_per_current;
    }
    const Message& message = command_message(settings_.layout);
    hal::CanFrame frame;
    if (!encode(message, std::span(currents).first(message.signals.size()), static_cast<std::uint8_t>(commands.sequence),
                frame)) {
      ++unsayable_;
      return false;
    }
    if (settings_.authentication != nullptr && message.can_be_authenticated) {
      settings_.authentication->seal(message, frame);
    }
    const bool taken = bus_.try_send(frame) == hal::CanSend::taken;
    if (sync_.send(bus_, {}) != hal::CanSend::taken) {
      ++lost_syncs_;
    }
    return taken;
  }

  const MessageCounters& readings(std::size_t message) const noexcept { return readings_[message].counters(); }
  std::uint64_t lost_syncs() const noexcept { return lost_syncs_; }
  /// Commands that were not sent because one is beyond the range of its signal.
  std::uint64_t unsayable() const noexcept { return unsayable_; }

 private:
  static constexpr std::size_t kMostMessages = kMostReadingMessages;
  static constexpr double kNode = 1.0;

  Bus& bus_;
  Clock& clock_;
  ControllerBusSettings settings_;
  std::array<MessageFollower, kMostMessages> readings_;
  std::array<std::array<double, kRedundantReadings>, hal::kMaxActuators> pistons_{};  ///< the newest readings [m]
  PeriodicFrame sync_;
  PeriodicFrame heartbeat_;
  std::uint64_t lost_syncs_ = 0;
  std::uint64_t unsayable_ = 0;
};

}  // namespace hotfire::firmware::can
