// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "firmware/interlock/faults.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware {

/// The limits of one actuator of a lab. A position is that of a piston [m].
struct ActuatorLimits {
  std::int64_t reading_age_ns = 0;
  double lowest_position = 0.0;  ///< where the piston may be, and be sent
  double highest_position = 0.0;
  double speed = 0.0;  ///< measured over `speed_cycles` [m/s]
  /// Limit of the pressure difference across the piston, in either direction [Pa]; infinite: it is not measured.
  double load_pressure = std::numeric_limits<double>::infinity();
};

/// The highest limit of a load pressure [Pa]. It is well within the range of a frame, so that a value beyond it is detected.
inline constexpr double kMostLoadPressure = 50e6;

/// The limits of a lab. A command is the piston position that the profile requires [m].
struct FaultLimits {
  static constexpr std::uint64_t kMostSpeedCycles = 64;

  std::int64_t command_age_ns = 0;  ///< of the newest command
  double lowest_reading = 0.0;      ///< what the sensor can give
  double highest_reading = 0.0;
  double disagreement = 0.0;    ///< between the two readings of one actuator
  double command_rate = 0.0;    ///< [m/s]
  double position_error = 0.0;  ///< between command and position
  std::uint64_t position_error_cycles =
      0;                               ///< for longer than this in a row: an actuator lags in every step it is asked for
  std::uint64_t speed_cycles = 1;      ///< over which a speed is measured; kMostSpeedCycles at most
  std::uint64_t read_back_cycles = 0;  ///< for which a line may read back other than it is commanded: contactors take time
  std::array<ActuatorLimits, hal::kMaxActuators> actuators{};
  /// The period of each message of a node: surplus messages are those of a second sender. 0: one in a period of the lab.
  std::int64_t reading_period_ns = 0;
  bool readings_answer_sync = false;  ///< one for each SYNC, which the lab sends in every cycle

  std::int64_t reading_due_ns(std::int64_t period_ns) const noexcept {
    return reading_period_ns == 0 ? period_ns : reading_period_ns;
  }
  std::int64_t longest_reading_age_ns() const noexcept {
    return std::ranges::max(actuators, {}, &ActuatorLimits::reading_age_ns).reading_age_ns;
  }
  /// Whether load pressures are measured: of all actuators or of none.
  bool has_load_pressure() const noexcept { return std::isfinite(actuators[0].load_pressure); }
};

/// One actuator in one cycle: its command, its two redundant readings, and its load pressure [Pa].
struct ObservedActuator {
  double command = 0.0;
  std::array<double, 2> readings{};
  std::array<std::int64_t, 2> reading_ages_ns{};
  double load_pressure = 0.0;  ///< 0, and never old, where it is not measured
  std::int64_t load_pressure_age_ns = 0;
};

/// The rest of the rig in one cycle.
struct ObservedRig {
  std::int64_t command_age_ns = 0;
  bool bad_frame = false;  ///< since the cycle before, as the seven that follow
  bool second_sender = false;
  bool command_not_answered = false;
  bool not_authentic = false;
  bool transmit_queue_full = false;
  bool overrun = false;
  bool dropped_recording = false;
  bool emergency_stop = false;  ///< pressed, or the line cannot be read
  bool hydraulic_enable = true;
  bool bus_off = false;
  bool bus_down = false;
  bool take_back_refused = false;       ///< a command is still before the bus, and the kernel does not take it back
  bool supply_reads_other = false;      ///< the supply is not what its line was set to in the cycle before
  bool fault_line_reads_other = false;  ///< as the supply
};

/// Finds the faults of a cycle before anything is sent in it. A value that is not finite is that fault and no other of its
/// actuator, because comparisons with limits have no meaning then. Pure logic, no allocation.
class FaultChecks {
 public:
  /// `period` in s.
  FaultChecks(const FaultLimits& limits, double period) noexcept : limits_(limits), period_(period) {}

  FaultSet look(const ObservedRig& rig, std::span<const ObservedActuator> actuators) noexcept {
    FaultSet found;
    found.add_if(!(rig.command_age_ns <= limits_.command_age_ns), Fault::stale_command);
    found.add_if(rig.bad_frame, Fault::bad_frame);
    found.add_if(rig.second_sender, Fault::second_sender);
    found.add_if(rig.command_not_answered, Fault::command_not_answered);
    found.add_if(rig.not_authentic, Fault::not_authentic);
    found.add_if(rig.transmit_queue_full, Fault::transmit_queue_full);
    found.add_if(rig.overrun, Fault::overrun);
    found.add_if(rig.dropped_recording, Fault::recorder_full);
    found.add_if(rig.emergency_stop, Fault::emergency_stop);
    found.add_if(!rig.hydraulic_enable, Fault::hydraulic_enable_lost);
    found.add_if(rig.bus_off, Fault::bus_off);
    found.add_if(rig.bus_down, Fault::bus_down);
    found.add_if(rig.take_back_refused, Fault::take_back_refused);
    supply_other_ = rig.supply_reads_other ? supply_other_ + 1 : 0;
    fault_line_other_ = rig.fault_line_reads_other ? fault_line_other_ + 1 : 0;
    found.add_if(supply_other_ > limits_.read_back_cycles, Fault::supply_read_back);
    found.add_if(fault_line_other_ > limits_.read_back_cycles, Fault::fault_read_back);
    const std::size_t count = std::min(actuators.size(), hal::kMaxActuators);
    for (std::size_t i = 0; i < count; ++i) {
      found |= look_at(actuators[i], limits_.actuators[i], last_[i]) |
               look_at_speed(actuators[i], limits_.actuators[i], tracks_[i]);
    }
    return found;
  }

  /// After a stop: the next commands are no longer compared with those of the cycle before.
  void forget() noexcept { last_ = {}; }

 private:
  struct Last {
    double command = 0.0;
    bool has_command = false;
    std::uint64_t error_cycles = 0;
  };

  /// Positions of an actuator in the last cycles; that of `cycles` is at the place of its remainder.
  struct Track {
    std::array<double, FaultLimits::kMostSpeedCycles> positions{};
    std::uint64_t cycles = 0;
  };

  FaultSet look_at_speed(const ObservedActuator& actuator, const ActuatorLimits& limits, Track& track) const noexcept {
    const double position = 0.5 * (actuator.readings[0] + actuator.readings[1]);
    if (!std::isfinite(position)) {
      track.cycles = 0;
      return {};
    }
    double& before = track.positions[track.cycles % limits_.speed_cycles];
    const bool is_known = track.cycles >= limits_.speed_cycles;
    const double speed = std::abs(position - before) / (static_cast<double>(limits_.speed_cycles) * period_);
    before = position;
    ++track.cycles;
    FaultSet found;
    found.add_if(is_known && !(speed <= limits.speed), Fault::speed);
    return found;
  }

  FaultSet look_at(const ObservedActuator& actuator, const ActuatorLimits& limits, Last& last) noexcept {
    const auto& [first, second] = actuator.readings;
    if (!std::isfinite(first) || !std::isfinite(second) || !std::isfinite(actuator.command) ||
        !std::isfinite(actuator.load_pressure)) {
      last = {};
      return Fault::not_finite;
    }
    FaultSet found;
    for (std::size_t i = 0; i < actuator.readings.size(); ++i) {
      const double reading = actuator.readings[i];
      found.add_if(!(reading >= limits_.lowest_reading && reading <= limits_.highest_reading), Fault::out_of_range);
      found.add_if(!(actuator.reading_ages_ns[i] <= limits.reading_age_ns), Fault::stale_sensor);
      found.add_if(!within(reading, limits), Fault::limit);
    }
    found.add_if(!(actuator.load_pressure_age_ns <= limits.reading_age_ns), Fault::stale_sensor);
    found.add_if(!(std::abs(actuator.load_pressure) <= limits.load_pressure), Fault::load_pressure);
    found.add_if(!(std::abs(first - second) <= limits_.disagreement), Fault::readings_disagree);
    found.add_if(!within(actuator.command, limits), Fault::limit);
    const double rate = last.has_command ? std::abs(actuator.command - last.command) / period_ : 0.0;
    // A line whose rate is the limit differs from it by the rounding of two positions.
    constexpr double kRounding = 1.0 + 1e-9;
    found.add_if(!(rate <= limits_.command_rate * kRounding), Fault::limit);
    const bool astray = !(std::abs(actuator.command - 0.5 * (first + second)) <= limits_.position_error);
    last = {actuator.command, true, astray ? last.error_cycles + 1 : 0};
    found.add_if(last.error_cycles > limits_.position_error_cycles, Fault::position_error);
    return found;
  }

  static bool within(double position, const ActuatorLimits& limits) noexcept {
    return position >= limits.lowest_position && position <= limits.highest_position;
  }

  FaultLimits limits_;
  double period_;
  std::array<Last, hal::kMaxActuators> last_{};
  std::array<Track, hal::kMaxActuators> tracks_{};
  std::uint64_t supply_other_ = 0;
  std::uint64_t fault_line_other_ = 0;
};

}  // namespace hotfire::firmware
