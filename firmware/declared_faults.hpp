#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "hal/plant_bus.hpp"

namespace hotfire::firmware {

/// What a plant plays on purpose, so that a controller can be tried on it.
///
/// Of a sensor: `stuck` holds what it read before; `biased` adds `value`; `noisy` adds white noise of rms `value`; `dropped`
/// is not sent; `delayed` is sent `value` seconds late. Of an actuator: `leak` has a leakage of `value` across the piston;
/// `lost_supply` has a supply pressure of `value`. `bus_off`: the plant neither receives nor sends.
enum class PlayedKind : std::uint8_t { stuck, biased, noisy, dropped, delayed, leak, lost_supply, bus_off };
inline constexpr std::array<std::string_view, 8> kPlayedKinds{"stuck",   "biased", "noisy",       "dropped",
                                                              "delayed", "leak",   "lost_supply", "bus_off"};

constexpr bool is_of_sensor(PlayedKind kind) noexcept { return kind <= PlayedKind::delayed; }
constexpr bool is_of_actuator(PlayedKind kind) noexcept {
  return kind == PlayedKind::leak || kind == PlayedKind::lost_supply;
}

/// The longest delay of a sensor [s].
inline constexpr double kLongestSensorDelay = 1.0;

/// One fault that a plant plays, from a time to a time [s] of the plant, which begins with its first cycle.
struct PlayedFault {
  PlayedKind kind = PlayedKind::stuck;
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  int actuator = 0;  ///< from 1; 0: every one
  int channel = 0;   ///< of a sensor: its place in the model's channels
  double value = 0.0;

  bool is_of(std::size_t one) const noexcept { return actuator == 0 || static_cast<std::size_t>(actuator) == one + 1; }
};

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

/// Plays the faults of the sensors of a plant on what they read. The same faults and readings give the same bits.
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

  /// Changes the readings of a cycle. `before` is what was sent in the cycle before it. Real-time. Returns the readings that
  /// are not sent, one bit each.
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
          reading += one.value * one.normal();
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
        : kind(fault.kind), cycles(fault, period), reading(place), value(fault.value), random(place + 1) {
      if (kind == PlayedKind::delayed) {
        past.resize(static_cast<std::size_t>(std::llround(std::min(value, kLongestSensorDelay) / period)));
      }
    }

    /// Takes a reading in and gives the one that is as late as the delay says.
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

    /// Of mean 0 and variance 1: the sum of twelve uniform numbers, which needs no function that a C library may round its
    /// own way. Uniform numbers by xorshift64* [Vigna 2016].
    double normal() noexcept {
      constexpr std::uint64_t kMultiplier = 0x2545f4914f6cdd1d;
      double sum = -6.0;
      for (int i = 0; i < 12; ++i) {
        random ^= random >> 12;
        random ^= random << 25;
        random ^= random >> 27;
        sum += static_cast<double>((random * kMultiplier) >> 11) * 0x1p-53;
      }
      return sum;
    }

    PlayedKind kind;
    CycleSpan cycles;
    std::size_t reading;
    double value;
    double held = 0.0;
    std::vector<double> past{};
    std::size_t next = 0;
    bool filled = false;
    std::uint64_t random;
  };

  std::vector<Played> played_;
};

/// A bus that is off while its faults say so: what arrives is lost, nothing is sent (`hal::PlantBus`).
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
