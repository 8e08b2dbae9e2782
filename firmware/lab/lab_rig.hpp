// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/can/command_echo.hpp"
#include "firmware/can/frame_budget.hpp"
#include "firmware/can/layout.hpp"
#include "firmware/can/message_follower.hpp"
#include "firmware/can/periodic_frame.hpp"
#include "firmware/lab/lab.hpp"
#include "firmware/lab/lab_end.hpp"
#include "firmware/lab/lab_lines.hpp"
#include "firmware/recording/recorder.hpp"
#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/gpio.hpp"
#include "hal/recording/fnv1a.hpp"

namespace hotfire::firmware {

/// A lab on its bus and lines. For the loop it is both plant and bus. A cycle reads the bus and the lines, checks for faults
/// and sets the lines. It then sends the currents of that cycle if anything may be driven. `Can` has the ids of
/// `can::controller_ids`, with load pressures if the lab has a limit of them.
///
/// Every frame of a cycle is checked, not only the newest. A frame that is damaged, lost, dropped by the kernel or of
/// another format is a bad frame. A repeated or earlier counter, a surplus frame, or a frame under an id of the lab is a
/// second sender.
///
/// After driving ends, a command that still waits one cycle later is taken back with `stop`, so that it cannot leave later.
/// If the kernel refuses this, it is asked again every kTakeBackEveryNs. The rig is faulted until it agrees.
///
/// The program may end (`ended`) when that is decided, the lines are set and the read-backs agree (`LabLeaving`).
///
/// After bus-off, down or a command that was taken back, the interlock refuses the first press of the arm button. This press
/// puts the bus into use again, without earlier frames. The next press arms.
template <hal::CanBus Can, hal::GpioLines Gpio, hal::Clock Clock>
class LabRig {
 public:
  /// Interval in which the kernel is asked again to take a command back.
  static constexpr std::int64_t kTakeBackEveryNs = 100'000'000;

  /// `wiring`: the places of the lab's inputs among those of `gpio`.
  LabRig(Lab& lab, Can& can, Gpio& gpio, const LabGpio& wiring, Clock& clock, can::Layout layout,
         std::int64_t period_ns) noexcept
      : lab_(lab),
        can_(can),
        gpio_(gpio),
        wiring_(wiring),
        clock_(clock),
        layout_(layout),
        piston_messages_(can::reading_messages(layout, lab.actuators())),
        messages_(piston_messages_ + (lab.limits().has_load_pressure() ? 1 : 0)),
        echo_(piston_messages_),
        sync_(can::sync::kMessage, period_ns),
        heartbeat_(can::heartbeat::kMessage, period_ns),
        take_back_every_(std::max<std::int64_t>(1, kTakeBackEveryNs / period_ns)),
        leaving_(period_ns, lab.limits().read_back_cycles),
        period_ns_(period_ns) {
    budgets_.fill({lab.limits().reading_due_ns(period_ns), lab.limits().longest_reading_age_ns()});
  }

  /// The recorder whose drops are a fault; null: nothing is recorded.
  void watch(const Recorder* recorder) noexcept { recorder_ = recorder; }

  /// Requires authentic readings, and authenticates commands. Call it before the loop.
  void authenticate(can::Authentication& authentication) noexcept {
    authentication_ = &authentication;
    for (can::MessageFollower& follower : followers_) {
      follower.require(&authentication);
    }
  }

  /// From any thread: requests the end of the profile and of the program. `ended` becomes true when nothing is driven after
  /// that, and when the profile is complete.
  void ask_to_stop_when(const std::atomic<bool>& asked) noexcept { stop_asked_ = &asked; }
  const std::atomic<bool>& ended() const noexcept { return ended_; }
  /// Number of cycles after which the lab requests a stop itself; 0: never.
  void stop_after(std::uint64_t cycles) noexcept { most_cycles_ = cycles; }

  /// Sets every output to off, whatever the interlock decides: after the end of the loop. False if they cannot be set.
  /// `hold_fault`: all except the fault line of a faulted rig.
  bool drop_lines(bool hold_fault = false) noexcept {
    constexpr int kTries = 3;
    const bool fault = hold_fault && lab_.outputs().interlock.fault_out;
    for (int i = 0; i < kTries; ++i) {
      if (gpio_.try_write(fault ? 1U << kFault : 0U)) {
        return true;
      }
    }
    return false;
  }

  /// Whether a command may still wait below the program: it must not be sent any more.
  bool may_have_command_before_bus() const noexcept { return drove_ || take_back_refused_; }

  bool try_receive_command(hal::Command&) noexcept {
    const std::int64_t now = clock_.now_ns();
    can_.receive(now);
    pending_ = can_.anything_pending();
    const bool heard = take_readings(now);
    take_lines();
    const bool driven = lab_.outputs().interlock.drive;
    inputs_.rig.command_age_ns = driven && sent_ns_ != 0 ? now - sent_ns_ : 0;
    inputs_.rig.command_not_answered = driven && can::has_echo(layout_) && echo_.age_ns(now) > lab_.limits().command_age_ns;
    inputs_.rig.overrun = overran_;
    inputs_.rig.transmit_queue_full = driven && not_taken_ >= kMostNotTaken;
    inputs_.rig.dropped_recording = recorder_ != nullptr && recorder_->dropping();
    inputs_.rig.bus_off = can_.state() == hal::CanState::bus_off;
    inputs_.rig.bus_down = can_.state() == hal::CanState::down || taken_back_;
    inputs_.rig.take_back_refused = take_back_refused_;
    ++cycles_;
    inputs_.stop = (stop_asked_ != nullptr && stop_asked_->load(std::memory_order_relaxed)) ||
                   (most_cycles_ != 0 && cycles_ > most_cycles_);
    overran_ = false;
    return heard;
  }

  void step(const hal::Command&) noexcept { lab_.step(inputs_); }

  bool try_send_reading(const hal::Reading&) noexcept {
    const InterlockOutputs& interlock = lab_.outputs().interlock;
    set_lines(interlock);
    if (heartbeat_.is_due()) {
      heartbeat_.send(can_, std::array{kNode, static_cast<double>(interlock.state)});
    }
    const bool taken = !interlock.drive || send_currents();
    sync_.send(can_, {});
    if (!interlock.drive) {
      take_back();
      echo_.forget();
      if (interlock.refused_press) {
        take_bus_into_use();
      }
      not_taken_ = 0;
      sent_ns_ = 0;
    }
    const bool seen_off = lines_set_ && !may_have_command_before_bus() && !inputs_.rig.supply_reads_other &&
                          !inputs_.rig.fault_line_reads_other;
    ended_.store(leaving_.may_end(interlock.drive, inputs_.stop || lab_.completed(), seen_off), std::memory_order_relaxed);
    return taken;
  }

  void note_overrun() noexcept { overran_ = true; }

  std::size_t actuators() const noexcept { return lab_.actuators(); }
  /// The commands [rad].
  std::span<const double> measured() const noexcept { return std::span(lab_.outputs().commands).first(lab_.actuators()); }
  static constexpr std::uint32_t missing() noexcept { return 0; }
  void add_to(hal::Fnv1a& hash) const noexcept { lab_.add_to(hash); }

  const Lab& lab() const noexcept { return lab_; }
  /// The inputs of the lab in this cycle.
  const LabInputs& inputs() const noexcept { return inputs_; }
  /// Messages that the lab receives: those of the pistons, then the load pressures.
  std::size_t messages() const noexcept { return messages_; }
  const can::Message& message(std::size_t which) const noexcept {
    return which < piston_messages_ ? can::reading_message(layout_, which) : can::load_pressure_message(layout_);
  }
  const can::MessageCounters& readings(std::size_t which) const noexcept { return followers_[which].counters(); }
  std::uint64_t unsayable() const noexcept { return unsayable_; }

 private:
  static constexpr std::size_t kMostMessages = can::kMostReadingMessages + 1;
  static constexpr double kNode = 1.0;
  /// A late confirmation by the driver is no fault once; it is one in two cycles in a row.
  static constexpr unsigned kMostNotTaken = 2;

  /// A count of what should not be.
  class Growth {
   public:
    /// Whether the count has grown since the last call.
    bool is_seen(std::uint64_t count) noexcept {
      const bool grown = count != before_;
      before_ = count;
      return grown;
    }

   private:
    std::uint64_t before_ = 0;
  };

  bool take_readings(std::int64_t now) noexcept {
    std::array<std::array<double, can::pistons_fd::kSignals.size()>, kMostMessages> values{};
    std::array<bool, kMostMessages> taken{};
    bool all = true;
    const std::int64_t due_now = lab_.limits().readings_answer_sync ? static_cast<std::int64_t>(cycles_) * period_ns_ : now;
    for (std::size_t i = 0; i < messages_; ++i) {
      const auto arrived_ns = followers_[i].take_newest(message(i), can_.arrivals(), i, values[i]);
      taken[i] = arrived_ns.has_value();
      arrived_ns_[i] = arrived_ns.value_or(arrived_ns_[i]);
      if (i < piston_messages_ && taken[i] && can::has_echo(layout_)) {
        echo_.note_echo(i, static_cast<std::uint8_t>(values[i][can::kEchoPlace]));
      }
      const auto came = std::count_if(can_.arrivals().begin(), can_.arrivals().end(),
                                      [i](const hal::CanArrival& arrival) { return arrival.subscription == i; });
      followers_[i].note_too_many(budgets_[i].excess(static_cast<std::uint64_t>(came), due_now));
      all = all && taken[i];
    }
    judge_frames();
    for (std::size_t i = 0; i < lab_.actuators(); ++i) {
      for (std::size_t reading = 0; reading < can::kRedundantReadings; ++reading) {
        const can::PistonPlace place = can::place_of_piston(layout_, i, reading);
        if (taken[place.message]) {
          inputs_.readings[i][reading] = values[place.message][place.value];
        }
        inputs_.ages_ns[i][reading] = age_ns(place.message, now);
      }
      if (messages_ > piston_messages_) {
        inputs_.load_pressures[i] = taken[piston_messages_] ? values[piston_messages_][i] : inputs_.load_pressures[i];
        inputs_.load_pressure_ages_ns[i] = age_ns(piston_messages_, now);
      }
    }
    return all;
  }

  /// Of the newest frame of a message.
  std::int64_t age_ns(std::size_t which, std::int64_t now) const noexcept {
    return arrived_ns_[which] == 0 ? kNever : now - arrived_ns_[which];
  }

  void judge_frames() noexcept {
    const hal::CanCounters& bus = can_.counters();
    std::uint64_t damaged = bus.dropped + bus.foreign;
    std::uint64_t of_two_senders = bus.impostors;
    std::uint64_t unauthentic = 0;
    for (std::size_t i = 0; i < messages_; ++i) {
      damaged += followers_[i].counters().damaged();
      of_two_senders += followers_[i].counters().of_two_senders();
      unauthentic += followers_[i].counters().unauthentic;
    }
    inputs_.rig.bad_frame = damaged_.is_seen(damaged);
    inputs_.rig.second_sender = of_two_senders_.is_seen(of_two_senders);
    inputs_.rig.not_authentic = unauthentic_.is_seen(unauthentic);
  }

  void take_lines() noexcept {
    const hal::GpioLevels changed = take_changes();
    hal::GpioLevels levels = 0;
    const bool readable = gpio_.try_read(levels) && lines_set_;
    const auto bit = [&](hal::GpioLevels set, LabInput line) {
      return wiring_.is_wired(line) && ((set >> wiring_.places[line]) & 1U) != 0;
    };
    const auto on = [&](LabInput line) { return readable && bit(levels, line); };
    const auto reads_other = [&](LabInput line, LabOutput output) {
      return wiring_.is_wired(line) && readable && bit(levels, line) != (((set_ >> output) & 1U) != 0);
    };
    inputs_.rig.emergency_stop = !on(kEmergencyStopReleased) || bit(changed, kEmergencyStopReleased);
    inputs_.rig.hydraulic_enable = on(kHydraulicEnabled) && !bit(changed, kHydraulicEnabled);
    inputs_.rig.supply_reads_other = reads_other(kSupplyReadBack, kSupply);
    inputs_.rig.fault_line_reads_other = reads_other(kFaultReadBack, kFault);
    // A line that cannot be read has not been seen off: a button held all the while would else be a press when it is let go.
    inputs_.arm = readable ? on(kArm) : inputs_.arm;
    inputs_.arm_changed = bit(changed, kArm);
    inputs_.start = readable ? on(kStart) : inputs_.start;
    inputs_.start_changed = bit(changed, kStart);
  }

  /// Inputs that have changed since the previous cycle. The direction is not used: for a pulse that is already over, the
  /// kernel reports the level that it finds. More edges than can be read or kept count as a change of every input.
  hal::GpioLevels take_changes() noexcept {
    constexpr int kMostReads = 8;
    std::array<hal::GpioEdge, 64> edges{};
    hal::GpioLevels changed = 0;
    bool all_read = false;
    for (int i = 0; i < kMostReads && !all_read; ++i) {
      const std::size_t count = gpio_.read_edges(edges);
      for (const hal::GpioEdge& edge : std::span(edges).first(count)) {
        changed |= hal::GpioLevels{1} << edge.input;
      }
      all_read = count < edges.size();
    }
    const std::uint64_t lost = gpio_.lost_edges();
    const bool all_known = all_read && lost == lost_edges_;
    lost_edges_ = lost;
    return all_known ? changed : ~hal::GpioLevels{0};
  }

  /// If the bus was given up, which the refused press then was about.
  void take_bus_into_use() noexcept {
    if ((can_.state() < hal::CanState::bus_off && !taken_back_) || !can_.rearm()) {
      return;
    }
    taken_back_ = false;
    arrived_ns_.fill(0);
    for (std::size_t i = 0; i < messages_; ++i) {
      followers_[i].forget();
      budgets_[i].forget();
    }
  }

  void set_lines(const InterlockOutputs& interlock) noexcept {
    beat_ = !beat_;
    set_ =
        (interlock.drive ? 1U << kSupply : 0U) | (beat_ ? 1U << kHeartbeat : 0U) | (interlock.fault_out ? 1U << kFault : 0U);
    lines_set_ = gpio_.try_write(set_);
  }

  bool send_currents() noexcept {
    const can::Message& message = can::command_message(layout_);
    hal::CanFrame frame;
    const std::uint8_t counter = counter_++;
    if (!can::encode(message, std::span(lab_.outputs().currents).first(message.signals.size()), counter, frame)) {
      ++unsayable_;
      return false;
    }
    if (authentication_ != nullptr && message.can_be_authenticated) {
      authentication_->seal(message, frame);
    }
    const hal::CanSend sent = can_.try_send(frame);
    const bool taken = sent == hal::CanSend::taken;
    not_taken_ = taken ? 0 : sent == hal::CanSend::queue_full ? kMostNotTaken : not_taken_ + 1;
    drove_ = drove_ || taken;
    if (taken) {
      sent_ns_ = clock_.now_ns();
      echo_.note_sent(counter, sent_ns_);
    }
    undriven_cycles_ = 0;
    return taken;
  }

  void take_back() noexcept {
    if (take_back_refused_) {
      ++since_take_back_;
      if (since_take_back_ >= take_back_every_) {
        ask_for_command();
      }
      return;
    }
    if (!drove_ || ++undriven_cycles_ < 2) {
      return;
    }
    drove_ = false;
    if (pending_) {
      ask_for_command();
    }
  }

  void ask_for_command() noexcept {
    since_take_back_ = 0;
    taken_back_ = can_.stop();
    take_back_refused_ = !taken_back_;
  }

  static constexpr std::int64_t kNever = std::int64_t{1} << 62;
  /// Half as much again as any limit, so that a frame can show that a limit is exceeded, and by how much.
  static_assert(can::load_pressures::kSignals[0].factor * can::load_pressures::kSignals[0].highest_raw >=
                1.5 * kMostLoadPressure);

  Lab& lab_;
  Can& can_;
  Gpio& gpio_;
  LabGpio wiring_;
  Clock& clock_;
  can::Layout layout_;
  std::size_t piston_messages_;
  std::size_t messages_;
  can::CommandEcho echo_;
  can::PeriodicFrame sync_;
  can::PeriodicFrame heartbeat_;
  std::int64_t take_back_every_;  ///< cycles
  LabLeaving leaving_;
  std::int64_t period_ns_;
  const Recorder* recorder_ = nullptr;
  const std::atomic<bool>* stop_asked_ = nullptr;
  std::atomic<bool> ended_{false};
  LabInputs inputs_;
  std::array<can::MessageFollower, kMostMessages> followers_;
  std::array<can::FrameBudget, kMostMessages> budgets_;
  std::array<std::int64_t, kMostMessages> arrived_ns_{};
  Growth damaged_;
  Growth of_two_senders_;
  Growth unauthentic_;
  can::Authentication* authentication_ = nullptr;
  std::uint64_t unsayable_ = 0;
  std::uint64_t undriven_cycles_ = 0;
  std::int64_t sent_ns_ = 0;  ///< when the last command was handed over; 0: none since driving began
  std::uint8_t counter_ = 0;
  unsigned not_taken_ = 0;
  bool overran_ = false;
  bool lines_set_ = true;
  hal::GpioLevels set_ = 0;  ///< what the outputs were set to
  std::uint64_t lost_edges_ = 0;
  std::uint64_t cycles_ = 0;
  std::uint64_t most_cycles_ = 0;
  bool beat_ = false;
  bool drove_ = false;    ///< a command was sent that is not known to be out
  bool pending_ = false;  ///< at the beginning of the cycle a frame of the one before was not out
  bool taken_back_ = false;
  bool take_back_refused_ = false;
  std::int64_t since_take_back_ = 0;  ///< cycles
};

}  // namespace hotfire::firmware
