// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hotfire::firmware {

/// The faults of a rig. The numbers are permanent, because they are in logs, in recordings and in people's memory. A fault
/// that is no longer raised keeps its number. Each has a section in docs/faults.md.
enum class Fault : std::uint8_t {
  stale_command = 1,
  stale_sensor = 2,
  out_of_range = 3,
  readings_disagree = 4,
  bad_frame = 5,
  bus_off = 6,
  bus_down = 7,
  transmit_queue_full = 8,
  emergency_stop = 9,
  hydraulic_enable_lost = 10,
  overrun = 11,
  position_error = 12,
  limit = 13,
  not_finite = 14,
  recorder_full = 15,
  take_back_refused = 16,
  supply_read_back = 17,
  fault_read_back = 18,
  speed = 19,
  load_pressure = 20,
  second_sender = 36,
  command_not_answered = 37,
  heartbeat_lost = 38,
  not_authentic = 39,
};

/// Every number is below this one, so that a set of faults is one word.
inline constexpr std::size_t kFaultNumbers = 64;

struct FaultText {
  Fault fault;
  std::string_view name;     ///< heading of its section in docs/faults.md
  std::string_view meaning;  ///< one line, for a log
};

/// In the order of their numbers, which may have gaps.
inline constexpr auto kFaults = std::to_array<FaultText>({
    {Fault::stale_command, "stale command", "no new command within its age limit"},
    {Fault::stale_sensor, "stale sensor", "a reading is older than its age limit"},
    {Fault::out_of_range, "out of range", "a reading is outside what its sensor can give"},
    {Fault::readings_disagree, "readings disagree", "two redundant readings are further apart than allowed"},
    {Fault::bad_frame, "bad frame", "a frame is damaged or lost"},
    {Fault::bus_off, "bus-off", "the CAN controller has switched itself off the bus"},
    {Fault::bus_down, "bus down", "the CAN interface is down"},
    {Fault::transmit_queue_full, "transmit queue full", "the bus does not take frames as fast as they are due"},
    {Fault::emergency_stop, "emergency stop", "the emergency stop is pressed, or its line is broken"},
    {Fault::hydraulic_enable_lost, "hydraulic enable lost", "the hydraulic supply is not enabled any more"},
    {Fault::overrun, "overrun", "a cycle ended after the next was due"},
    {Fault::position_error, "position error", "an actuator does not follow its command"},
    {Fault::limit, "limit", "a command, its rate or a position is beyond its limit"},
    {Fault::not_finite, "non-finite state", "a value is not a number, or infinite"},
    {Fault::recorder_full, "recorder full", "cycles are no longer recorded"},
    {Fault::take_back_refused, "take-back refused",
     "a command is still before the bus and the kernel does not take it back"},
    {Fault::supply_read_back, "supply read-back", "the supply is on while commanded off, or off while commanded on"},
    {Fault::fault_read_back, "fault-line read-back", "the fault line differs from its commanded state"},
    {Fault::speed, "speed", "an actuator moves faster than its limit"},
    {Fault::load_pressure, "load pressure", "the load pressure of an actuator is beyond its limit"},
    {Fault::second_sender, "second sender", "two nodes send the frames of one message"},
    {Fault::command_not_answered, "command not answered", "a node does not confirm the newest commands"},
    {Fault::heartbeat_lost, "heartbeat lost", "the controller sends no HEARTBEAT any more"},
    {Fault::not_authentic, "not authentic", "a frame has no valid authentication code, or is a replay"},
});

/// Of a fault of the list.
constexpr const FaultText& text_of(Fault fault) noexcept {
  return *std::find_if(kFaults.begin(), kFaults.end(), [fault](const FaultText& text) { return text.fault == fault; });
}

/// A count for each fault, by its number.
using FaultCounts = std::array<std::uint64_t, kFaultNumbers>;

/// Some of the faults.
class FaultSet {
 public:
  constexpr FaultSet() noexcept = default;
  constexpr FaultSet(Fault fault) noexcept : bits_(bit(fault)) {}  // NOLINT(google-explicit-constructor): one is a set

  static constexpr FaultSet all() noexcept {
    FaultSet set;
    for (const FaultText& text : kFaults) {
      set |= text.fault;
    }
    return set;
  }

  constexpr FaultSet& operator|=(FaultSet other) noexcept {
    bits_ |= other.bits_;
    return *this;
  }
  constexpr FaultSet& operator&=(FaultSet other) noexcept {
    bits_ &= other.bits_;
    return *this;
  }
  friend constexpr FaultSet operator&(FaultSet one, FaultSet other) noexcept { return one &= other; }
  friend constexpr FaultSet operator|(FaultSet one, FaultSet other) noexcept { return one |= other; }
  friend constexpr bool operator==(FaultSet one, FaultSet other) noexcept = default;

  /// Adds the fault if it is so.
  constexpr void add_if(bool present, Fault fault) noexcept { bits_ |= present ? bit(fault) : 0; }

  constexpr bool any() const noexcept { return bits_ != 0; }
  constexpr bool has(Fault fault) const noexcept { return (bits_ & bit(fault)) != 0; }
  constexpr int count() const noexcept { return std::popcount(bits_); }

 private:
  static constexpr std::uint64_t bit(Fault fault) noexcept { return std::uint64_t{1} << static_cast<unsigned>(fault); }

  std::uint64_t bits_ = 0;
};

/// Faults of outputs that should be off while nothing is driven. They make a safe rig faulted too.
inline constexpr FaultSet kFaultsOfASafeRig =
    FaultSet(Fault::take_back_refused) | Fault::supply_read_back | Fault::fault_read_back;

}  // namespace hotfire::firmware
