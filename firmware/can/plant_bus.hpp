// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

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
  std::int64_t command_age_ns = std::numeric_limits<std::int64_t>::max();    ///< a command that is older counts as none
  std::int64_t heartbeat_age_ns = std::numeric_limits<std::int64_t>::max();  ///< of the controller's last sign of life
  Authentication* authentication = nullptr;    ///< of commands and readings, if it is asked for
  std::optional<std::size_t> load_pressure{};  ///< which value of an actuator that is [Pa]; none: it is not sent
  bool heartbeat_optional = false;             ///< a controller that has never sent a HEARTBEAT is followed all the same
};

/// The plant's side of a CAN bus (`hal::PlantBus`). It receives the command of its layout. It sends the readings of its
/// actuators, with the first value of each as both redundant ones, and its status. It sends load pressures on request, and
/// the readings of string potentiometers if there are any. `Bus` has the ids of `plant_ids`.
///
/// A servovalve gets no current in these cases, and the next frame is then the first of a new series:
///
/// - The newest command is older than its age limit.
/// - The controller's HEARTBEAT is older than its limit, or has not come for that time since the first command.
/// - A frame that a single controller does not send has come within `kSecondSenderHoldNs`: the plant cannot know which of
///   two is right.
/// - A command is not authentic.
///
/// STATUS carries the number of that fault. Readings that a declared fault suppresses are left out. In a frame of several
/// actuators they are held, and the frame is left out if no reading remains.
template <hal::CanBus Bus, hal::Clock Clock>
class PlantBus {
 public:
  PlantBus(Bus& bus, Clock& clock, const PlantBusSettings& settings) noexcept
      : bus_(bus),
        clock_(clock),
        settings_(settings),
        status_(status::kMessage, settings.period_ns),
        strings_(string_message(settings.layout, 0), settings.period_ns) {
    commands_.require(settings.authentication);
  }

  /// Time for which one frame of a second controller keeps the valves without current. It is the time between two STATUS
  /// frames, so that one of them reports it.
  static constexpr std::int64_t kSecondSenderHoldNs = 1'000'000 * std::int64_t{status::kMessage.cycle_ms};

  bool try_receive_command(hal::Command& command) noexcept {
    const std::int64_t now = clock_.now_ns();
    bus_.receive(now);
    std::array<double, hal::kMaxActuators> currents{};
    const auto arrived_ns = commands_.take_newest(command_message(settings_.layout), bus_.arrivals(), kCommandBox, currents);
    const bool too_old = arrived_ns && now - *arrived_ns > settings_.command_age_ns;
    too_old_ += too_old ? 1 : 0;
    const Fault refused = refuses_controller(now, arrived_ns);
    const bool first_refused = refused != Fault{} && refused_ == Fault{};
    refused_ = refused;
    if (refused != Fault{}) {
      commanded_ = false;
      stale_ = false;
      return first_refused && clear(command);
    }
    if (arrived_ns && !too_old) {
      command.values.fill(0.0);
      for (std::size_t i = 0; i < settings_.actuators; ++i) {
        command.values[i] = settings_.command_per_current * currents[i];
      }
      command.sequence = commands_.sequence();
      arrived_ns_ = *arrived_ns;
      commanded_ = true;
      stale_ = false;
      return true;
    }
    return is_first_stale_cycle(now) && clear(command);
  }

  bool try_send_reading(const hal::Reading& reading) noexcept {
    if (status_.is_due()) {
      const Fault fault = refused_ != Fault{} ? refused_ : stale_ ? Fault::stale_command : Fault{};
      const double superseded = static_cast<double>(commands().superseded % kCounts);
      status_.send(bus_, std::array{static_cast<double>(RigState::running), static_cast<double>(fault),
                                    static_cast<double>(overruns_ % kCounts), superseded});
    }
    bool taken = is_fd(settings_.layout) ? send_fd(reading) : send_classic(reading);
    taken = send_load_pressures(reading) && taken;
    if (reading.string_count > 0 && strings_.is_due()) {
      send_strings(reading);
    }
    return taken;
  }

  /// A cycle of the loop has overrun.
  void note_overrun() noexcept { ++overruns_; }

  const MessageCounters& commands() const noexcept { return commands_.counters(); }
  const MessageCounters& heartbeats() const noexcept { return heartbeats_.counters(); }
  /// Cycles without a command within its age limit, from the first command on.
  std::uint64_t stale_cycles() const noexcept { return stale_cycles_; }
  /// Commands that were too old when the loop read them, and were not used.
  std::uint64_t too_old() const noexcept { return too_old_; }
  /// Frames that were not sent because a reading is beyond the range of its signal.
  std::uint64_t unsayable() const noexcept { return unsayable_; }

 private:
  static constexpr std::uint64_t kCounts = 65536;
  static constexpr std::size_t kCommandBox = 0;  ///< as in `plant_ids`
  static constexpr std::size_t kHeartbeatBox = 1;

  /// The reason why no command is used, although one may be present; none if one is used. `commanded_ns`: its time of
  /// arrival, if one has come.
  Fault refuses_controller(std::int64_t now, std::optional<std::int64_t> commanded_ns) noexcept {
    std::array<double, heartbeat::kSignals.size()> said{};
    const auto heard_ns = heartbeats_.take_newest(heartbeat::kMessage, bus_.arrivals(), kHeartbeatBox, said);
    if (commanded_ns && !heartbeat_due_ && !settings_.heartbeat_optional) {
      heartbeat_due_ = true;
      heartbeat_ns_ = *commanded_ns;
    }
    heartbeat_due_ = heartbeat_due_ || heard_ns;
    heartbeat_ns_ = heard_ns.value_or(heartbeat_ns_);
    const std::uint64_t of_two_senders =
        commands().of_two_senders() + heartbeats().of_two_senders() + bus_.counters().impostors;
    if (of_two_senders != of_two_senders_) {
      of_two_senders_ = of_two_senders;
      rival_heard_ = true;
      rival_ns_ = now;
    }
    if (commands().unauthentic != unauthentic_) {
      unauthentic_ = commands().unauthentic;
      forgery_heard_ = true;
      forgery_ns_ = now;
    }
    if (forgery_heard_ && now - forgery_ns_ < kSecondSenderHoldNs) {
      return Fault::not_authentic;
    }
    if (rival_heard_ && now - rival_ns_ < kSecondSenderHoldNs) {
      return Fault::second_sender;
    }
    if (heartbeat_due_ && now - heartbeat_ns_ > settings_.heartbeat_age_ns) {
      heartbeats_.forget();
      return Fault::heartbeat_lost;
    }
    return Fault{};
  }

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
    if (settings_.authentication != nullptr && message.can_be_authenticated) {
      settings_.authentication->seal(message, frame);
    }
    return bus_.try_send(frame) == hal::CanSend::taken;
  }

  /// The content that every reading message of the layout has.
  using Values = std::array<std::array<double, pistons_fd::kSignals.size()>, kMostReadingMessages>;

  Values values_of(const hal::Reading& reading) const noexcept {
    Values values{};
    for (std::size_t message = 0; has_echo(settings_.layout) && message < values.size(); ++message) {
      values[message][kEchoPlace] = static_cast<double>(static_cast<std::uint8_t>(reading.command_sequence));
    }
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      for (std::size_t redundant = 0; redundant < kRedundantReadings; ++redundant) {
        const PistonPlace place = place_of_piston(settings_.layout, i, redundant);
        values[place.message][place.value] = reading.values[i * settings_.channels];
      }
    }
    return values;
  }

  bool send_message(std::size_t which, const Values& values, const hal::Reading& reading) noexcept {
    const Message& message = reading_message(settings_.layout, which);
    return send(message, std::span(values[which]).first(message.signals.size()), reading.sequence);
  }

  bool send_classic(const hal::Reading& reading) noexcept {
    const Values values = values_of(reading);
    bool taken = true;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      for (std::size_t redundant = 0; redundant < (is_split(settings_.layout) ? kRedundantReadings : 1); ++redundant) {
        if (!is_missing(reading, i * settings_.channels)) {
          taken = send_message(place_of_piston(settings_.layout, i, redundant).message, values, reading) && taken;
        }
      }
    }
    return taken;
  }

  bool send_fd(const hal::Reading& reading) noexcept {
    const Values values = values_of(reading);
    std::size_t missing = 0;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      missing += is_missing(reading, i * settings_.channels) ? 1 : 0;
    }
    bool taken = true;
    const std::size_t messages =
        missing == settings_.actuators ? 0 : reading_messages(settings_.layout, settings_.actuators);
    for (std::size_t which = 0; which < messages; ++which) {
      taken = send_message(which, values, reading) && taken;
    }
    return taken;
  }

  /// True if there is nothing to send.
  bool send_load_pressures(const hal::Reading& reading) noexcept {
    std::array<double, hal::kMaxActuators> pressures{};
    bool any = false;
    for (std::size_t i = 0; settings_.load_pressure && i < settings_.actuators; ++i) {
      const std::size_t place = i * settings_.channels + *settings_.load_pressure;
      pressures[i] = reading.values[place];
      any = any || !is_missing(reading, place);
    }
    const Message& message = load_pressure_message(settings_.layout);
    return !any || send(message, std::span(pressures).first(message.signals.size()), reading.sequence);
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
  MessageFollower heartbeats_;
  PeriodicFrame status_;
  PeriodicFrame strings_;  ///< says when they are due
  std::uint8_t string_counter_ = 0;
  std::int64_t arrived_ns_ = 0;
  std::int64_t heartbeat_ns_ = 0;  ///< when the last one has come, or the first command before any has
  std::int64_t rival_ns_ = 0;
  std::uint64_t of_two_senders_ = 0;
  Fault refused_{};
  bool heartbeat_due_ = false;
  bool rival_heard_ = false;
  std::uint64_t unauthentic_ = 0;
  std::int64_t forgery_ns_ = 0;
  bool forgery_heard_ = false;
  bool commanded_ = false;
  bool stale_ = false;
  std::uint64_t stale_cycles_ = 0;
  std::uint64_t too_old_ = 0;
  std::uint64_t unsayable_ = 0;
  std::uint64_t overruns_ = 0;
};

}  // namespace hotfire::firmware::can
