// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "firmware/plant/white_noise.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware {

/// Faults that a plant simulates, to test a controller.
///
/// Of a sensor: `stuck` holds the last reading; `biased` adds `value`; `noisy` adds white noise of rms `value`; `dropped` is
/// not sent; `delayed` is sent `value` seconds late. Of an actuator: `leak` has a leakage of `value` across the piston;
/// `lost_supply` has a supply pressure of `value`. `bus_off`: the plant neither receives nor sends. Of an engine: `torque`
/// of `value` turns it towards positive angles of the actuator's axis; `thrust` of `value` replaces the declared one.
enum class PlayedKind : std::uint8_t { stuck, biased, noisy, dropped, delayed, leak, lost_supply, bus_off, torque, thrust };
inline constexpr std::array<std::string_view, 10> kPlayedKinds{"stuck", "biased",      "noisy",   "dropped", "delayed",
                                                               "leak",  "lost_supply", "bus_off", "torque",  "thrust"};

constexpr bool is_of_sensor(PlayedKind kind) noexcept { return kind <= PlayedKind::delayed; }
constexpr bool is_of_actuator(PlayedKind kind) noexcept {
  return kind == PlayedKind::leak || kind == PlayedKind::lost_supply;
}

constexpr bool is_of_engine(PlayedKind kind) noexcept { return kind == PlayedKind::torque || kind == PlayedKind::thrust; }

/// The largest torque [N m] and thrust [N] of an engine.
inline constexpr double kLargestTorque = 1e7;
inline constexpr double kLargestThrust = 1e8;

/// The longest delay of a sensor [s].
inline constexpr double kLongestSensorDelay = 1.0;

/// One simulated fault, from a time to a time [s] of the plant, whose time begins with its first cycle.
struct PlayedFault {
  PlayedKind kind = PlayedKind::stuck;
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  int actuator = 0;  ///< from 1; 0: every one
  int channel = 0;   ///< of a sensor: its place in the model's channels
  double value = 0.0;

  bool is_of(std::size_t one) const noexcept { return actuator == 0 || static_cast<std::size_t>(actuator) == one + 1; }
};

/// The parameters of an axis during a fault of its actuator. An axis without hydraulics does not change.
template <class Parameters>
void put_into(Parameters& axis, const PlayedFault& fault) {
  if constexpr (requires { axis.actuator.leakage; }) {
    (fault.kind == PlayedKind::leak ? axis.actuator.leakage : axis.actuator.supply_pressure) = fault.value;
  }
}

/// A span of cycles.
struct CycleSpan {
  /// The cycles that begin in the fault's time.
  CycleSpan(const PlayedFault& fault, double period) noexcept
      : from(first(fault.from, period)), to(first(fault.to, period)) {}

  bool has(std::uint64_t cycle) const noexcept { return cycle >= from && cycle < to; }

  std::uint64_t from = 0;
  std::uint64_t to = 0;

 private:
  static std::uint64_t first(double time, double period) noexcept {
    constexpr double kRounding = 1e-6;  // a time that is a whole number of periods is that cycle
    constexpr double kNever = 1e18;
    return static_cast<std::uint64_t>(std::min(std::ceil(time / period - kRounding), kNever));
  }
};

/// External loads on the engines of a plant by declared faults.
class PlayedLoads {
 public:
  PlayedLoads(const std::vector<PlayedFault>& faults, double period) {
    for (const PlayedFault& fault : faults) {
      if (is_of_engine(fault.kind)) {
        loads_.push_back({fault, CycleSpan(fault, period)});
      }
    }
  }

  bool any() const noexcept { return !loads_.empty(); }

  /// The torque on an actuator's engine in a cycle: the sum of all active faults [N m]. Real-time.
  double torque(std::uint64_t cycle, std::size_t actuator) const noexcept {
    double sum = 0.0;
    for (const Load& load : loads_) {
      sum += load.is(PlayedKind::torque, cycle) && load.fault.is_of(actuator) ? load.fault.value : 0.0;
    }
    return sum;
  }

  /// The thrust of an engine in a cycle [N]; `declared` if no fault sets one. Real-time.
  double thrust(std::uint64_t cycle, std::size_t engine, double declared) const noexcept {
    for (const Load& load : loads_) {
      if (load.is(PlayedKind::thrust, cycle) && (load.fault.is_of(2 * engine) || load.fault.is_of(2 * engine + 1))) {
        return load.fault.value;
      }
    }
    return declared;
  }

 private:
  struct Load {
    PlayedFault fault;
    CycleSpan cycles;

    bool is(PlayedKind kind, std::uint64_t cycle) const noexcept { return fault.kind == kind && cycles.has(cycle); }
  };

  std::vector<Load> loads_;
};

/// Applies the faults of sensors to their readings. The same faults and readings give the same bits.
class PlayedSensors {
 public:
  /// `period` in s, `channels` an actuator.
  PlayedSensors(const std::vector<PlayedFault>& faults, double period, std::size_t actuators, std::size_t channels) {
    for (const PlayedFault& fault : faults) {
      for (std::size_t actuator = 0; is_of_sensor(fault.kind) && actuator < actuators; ++actuator) {
        if (fault.is_of(actuator)) {
          played_.emplace_back(fault, period, actuator * channels + static_cast<std::size_t>(fault.channel));
        }
      }
    }
  }

  /// Changes the readings of a cycle. `before` has the readings that were sent in the previous cycle. Real-time. Returns the
  /// readings that are not sent, one bit each.
  std::uint32_t play(std::uint64_t cycle, std::span<const double> before, std::span<double> readings) noexcept {
    std::uint32_t missing = 0;
    for (Played& one : played_) {
      double& reading = readings[one.reading];
      const double late = one.kept(reading);
      if (!one.cycles.has(cycle)) {
        continue;
      }
      if (cycle == one.cycles.from) {
        one.held = before[one.reading];
      }
      switch (one.kind) {
        case PlayedKind::biased:
          reading += one.value;
          break;
        case PlayedKind::noisy:
          reading += one.value * one.noise();
          break;
        case PlayedKind::delayed:
          reading = late;
          break;
        case PlayedKind::dropped:
          missing |= std::uint32_t{1} << one.reading;
          reading = one.held;
          break;
        default:
          reading = one.held;
      }
    }
    return missing;
  }

 private:
  struct Played {
    Played(const PlayedFault& fault, double period, std::size_t place)
        : kind(fault.kind), cycles(fault, period), reading(place), value(fault.value), noise(place + 1) {
      if (kind == PlayedKind::delayed) {
        past.resize(static_cast<std::size_t>(std::llround(std::min(value, kLongestSensorDelay) / period)));
      }
    }

    /// Takes a reading and returns the reading that is older by the delay.
    double kept(double now) noexcept {
      if (past.empty()) {
        return now;
      }
      if (!filled) {
        std::fill(past.begin(), past.end(), now);
        filled = true;
      }
      const double late = past[next];
      past[next] = now;
      next = (next + 1) % past.size();
      return late;
    }

    PlayedKind kind;
    CycleSpan cycles;
    std::size_t reading;
    double value;
    double held = 0.0;
    std::vector<double> past{};
    std::size_t next = 0;
    bool filled = false;
    WhiteNoise noise;
  };

  std::vector<Played> played_;
};

/// The readings of a plant's sensors with the faults applied, cycle by cycle.
class PlayedReadings {
 public:
  /// `period` in s, `channels` an actuator.
  PlayedReadings(const std::vector<PlayedFault>& faults, double period, std::size_t actuators, std::size_t channels)
      : readings_(actuators * channels), before_(readings_.size()), sensors_(faults, period, actuators, channels) {}

  /// Before the first cycle, without faults. `measure(readings)` fills in the readings of the sensors.
  template <class Measure>
  void start(Measure&& measure) noexcept {
    measure(std::span(readings_));
  }

  /// At the end of a cycle. Real-time.
  template <class Measure>
  void take(Measure&& measure) noexcept {
    before_.swap(readings_);
    measure(std::span(readings_));
    missing_ = sensors_.play(cycle_++, before_, readings_);
  }

  /// The cycle that is under way, from 0.
  std::uint64_t cycle() const noexcept { return cycle_; }
  std::span<const double> values() const noexcept { return readings_; }
  /// The readings that are not sent, one bit each.
  std::uint32_t missing() const noexcept { return missing_; }

 private:
  std::vector<double> readings_;
  std::vector<double> before_;  ///< what was sent in the cycle before
  PlayedSensors sensors_;
  std::uint64_t cycle_ = 0;
  std::uint32_t missing_ = 0;
};

/// A bus that is off during its faults: received frames are lost, and nothing is sent (`hal::PlantBus`).
template <hal::PlantBus Bus>
class PlayedBus {
 public:
  PlayedBus(Bus& bus, const std::vector<PlayedFault>& faults, double period) : bus_(bus) {
    for (const PlayedFault& fault : faults) {
      if (fault.kind == PlayedKind::bus_off) {
        off_.emplace_back(fault, period);
      }
    }
  }

  bool try_receive_command(hal::Command& command) noexcept {
    const std::uint64_t cycle = cycle_++;
    is_off_ = std::any_of(off_.begin(), off_.end(), [cycle](const CycleSpan& span) { return span.has(cycle); });
    if (is_off_) {
      bus_.try_receive_command(lost_);
      return false;
    }
    return bus_.try_receive_command(command);
  }

  bool try_send_reading(const hal::Reading& reading) noexcept { return !is_off_ && bus_.try_send_reading(reading); }

  void note_overrun() noexcept {
    if constexpr (requires { bus_.note_overrun(); }) {
      bus_.note_overrun();
    }
  }

 private:
  Bus& bus_;
  std::vector<CycleSpan> off_;
  std::uint64_t cycle_ = 0;
  bool is_off_ = false;
  hal::Command lost_;
};

}  // namespace hotfire::firmware
