// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "firmware/interlock/fault_checks.hpp"
#include "firmware/interlock/interlock.hpp"
#include "firmware/lab/profile.hpp"
#include "hal/plant_bus.hpp"
#include "hal/recording/fnv1a.hpp"

namespace hotfire::firmware {

/// Settings of a lab: its actuators and their limits.
struct LabSettings {
  Profile profile{{}};
  std::size_t actuators = 1;
  FaultLimits limits;
  double piston_per_command = 1.0;   ///< position of a piston per command [m/rad]
  double current_per_command = 0.0;  ///< of an amplifier that closes the position loop itself [A/rad]; 0: it does not
  double current_per_error = 0.0;    ///< of the position loop closed here [A/m]; 0: it is not
  double current_limit = 0.0;        ///< what the amplifiers are given at most [A]
  double approach_rate = 0.0;        ///< from the pistons' positions to where the profile begins [rad/s]
  double rest_speed = 0.0;           ///< a slower piston is at rest [m/s]
  InterlockSettings interlock;       ///< how long an actuator may take to come to rest among them
  std::uint64_t most_overruns = 0;   ///< in a row that are no fault
};

/// Inputs of a lab in a cycle: the rig, the readings of every actuator, and a person's switches.
struct LabInputs {
  ObservedRig rig;
  std::array<std::array<double, 2>, hal::kMaxActuators> readings{};  ///< [m]
  std::array<std::array<std::int64_t, 2>, hal::kMaxActuators> ages_ns{};
  PerActuator load_pressures{};  ///< [Pa]; where the limits are of them, as their ages
  std::array<std::int64_t, hal::kMaxActuators> load_pressure_ages_ns{};
  bool arm = false;          ///< what the lines of the buttons say
  bool arm_changed = false;  ///< since the cycle before
  bool start = false;
  bool start_changed = false;
  bool stop = false;
};

/// The outputs of a lab in that cycle.
struct LabOutputs {
  InterlockOutputs interlock;
  PerActuator commands{};  ///< [rad]; finite
  PerActuator currents{};  ///< [A]; to be sent only if `interlock.drive`
};

/// Drives actuators through a profile behind the interlock. When armed, it holds them at their positions. When started, it
/// brings them slowly to the beginning of the profile and runs the profile. At the end of the profile or on a stop request,
/// it holds them at their positions. Pure logic: no clock, no bus, no allocation.
class Lab {
 public:
  /// `period` in s.
  Lab(LabSettings settings, double period)
      : settings_(std::move(settings)),
        period_(period),
        checks_(settings_.limits, period),
        interlock_(settings_.interlock) {}

  const LabOutputs& step(LabInputs inputs) noexcept {
    overruns_ = inputs.rig.overrun ? overruns_ + 1 : 0;
    inputs.rig.overrun = overruns_ > settings_.most_overruns;
    look_at_motion(inputs);
    const RigState before = outputs_.interlock.state;
    const bool driven = outputs_.interlock.drive;
    if (!driven) {
      // Nothing is asked of an actuator: it is where it should be, and a command to come is compared with none before.
      follow_pistons();
      checks_.forget();
    } else if (before == RigState::running) {
      advance();
    }
    const bool stop = inputs.stop || (before == RigState::running && completed_);
    const bool at_rest = still_cycles_ >= kStillCycles;
    outputs_.interlock = interlock_.step({look(inputs), inputs.arm, inputs.arm_changed, inputs.start, inputs.start_changed,
                                          stop, at_rest, inputs.rig.supply_reads_other});
    if (before == RigState::stopping && outputs_.interlock.state == RigState::safe) {
      came_to_rest_ = at_rest;
    }
    if (before != RigState::faulted && outputs_.interlock.fault_out) {
      ++fault_counts_[static_cast<std::size_t>(outputs_.interlock.first)];
    }
    if (!driven && outputs_.interlock.drive) {
      follow_pistons();
      begin_profile();
    }
    leave_out_what_is_not_finite();
    set_currents();
    return outputs_;
  }

  const LabOutputs& outputs() const noexcept { return outputs_; }
  std::size_t actuators() const noexcept { return settings_.actuators; }
  const FaultLimits& limits() const noexcept { return settings_.limits; }
  /// Positions of the pistons, each the mean of its readings [m].
  std::span<const double> positions() const noexcept { return std::span(positions_).first(settings_.actuators); }
  /// Adds the commands and the positions.
  void add_to(hal::Fnv1a& hash) const noexcept {
    hash.add(std::span(outputs_.commands).first(settings_.actuators));
    hash.add(positions());
  }
  /// Whether the whole profile has been run since the last arming.
  bool completed() const noexcept { return completed_; }
  /// False if the time to stop was over before every piston was at rest, since the last arming.
  bool came_to_rest() const noexcept { return came_to_rest_; }
  std::uint64_t armings() const noexcept { return armings_; }
  /// How often a fault was the first that made the rig faulted.
  std::uint64_t times_first(Fault fault) const noexcept { return fault_counts_[static_cast<std::size_t>(fault)]; }

 private:
  static constexpr std::uint64_t kStillCycles = 20;

  void look_at_motion(const LabInputs& inputs) noexcept {
    bool still = true;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      const double position = 0.5 * (inputs.readings[i][0] + inputs.readings[i][1]);
      still = still && std::abs(position - positions_[i]) <= settings_.rest_speed * period_;
      positions_[i] = position;
    }
    still_cycles_ = still ? still_cycles_ + 1 : 0;
  }

  void follow_pistons() noexcept {
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      outputs_.commands[i] = positions_[i] / settings_.piston_per_command;
    }
  }

  /// A command that is not finite is a fault and is not sent. It is not returned either, because the loop of a plant would
  /// end at it.
  void leave_out_what_is_not_finite() noexcept {
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      const double present = std::isfinite(positions_[i]) ? positions_[i] / settings_.piston_per_command : 0.0;
      outputs_.commands[i] = std::isfinite(outputs_.commands[i]) ? outputs_.commands[i] : present;
    }
  }

  void begin_profile() noexcept {
    time_ = 0.0;
    at_begin_ = false;
    completed_ = false;
    came_to_rest_ = true;
    ++armings_;
  }

  /// The commands of the next cycle of a running profile.
  void advance() noexcept {
    if (at_begin_) {
      time_ += period_;
      completed_ = time_ >= settings_.profile.duration();
      outputs_.commands = settings_.profile.at(time_);
      return;
    }
    const PerActuator begin = settings_.profile.at(0.0);
    const double most = settings_.approach_rate * period_;
    at_begin_ = true;
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      double& command = outputs_.commands[i];
      const double left = begin[i] - command;
      at_begin_ = at_begin_ && std::abs(left) <= most;
      command += std::clamp(left, -most, most);
    }
  }

  FaultSet look(const LabInputs& inputs) noexcept {
    std::array<ObservedActuator, hal::kMaxActuators> actuators{};
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      actuators[i] = {settings_.piston_per_command * outputs_.commands[i], inputs.readings[i], inputs.ages_ns[i],
                      inputs.load_pressures[i], inputs.load_pressure_ages_ns[i]};
    }
    return checks_.look(inputs.rig, std::span(actuators).first(settings_.actuators));
  }

  void set_currents() noexcept {
    for (std::size_t i = 0; i < settings_.actuators; ++i) {
      const double error = settings_.piston_per_command * outputs_.commands[i] - positions_[i];
      const double current = settings_.current_per_command * outputs_.commands[i] + settings_.current_per_error * error;
      outputs_.currents[i] = std::clamp(current, -settings_.current_limit, settings_.current_limit);
    }
  }

  LabSettings settings_;
  double period_;
  FaultChecks checks_;
  Interlock interlock_;
  LabOutputs outputs_;
  std::array<double, hal::kMaxActuators> positions_{};
  std::uint64_t still_cycles_ = 0;
  std::uint64_t armings_ = 0;
  std::uint64_t overruns_ = 0;
  FaultCounts fault_counts_{};
  double time_ = 0.0;
  bool at_begin_ = false;
  bool completed_ = false;
  bool came_to_rest_ = true;
};

}  // namespace hotfire::firmware
