// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// A number in a CAN frame: `physical = offset + factor raw`, raw little-endian (Intel) from bit `start` on.
struct CanSignal {
  std::string name;
  unsigned start = 0;   ///< bit 8 i + j is bit j of byte i
  unsigned length = 0;  ///< bits, up to 32
  bool is_signed = false;
  double factor = 1.0;
  double offset = 0.0;
  std::int64_t lowest_raw = 0;  ///< both ends of what a sender may send
  std::int64_t highest_raw = 0;
  std::string unit;

  double physical(std::int64_t raw) const { return offset + factor * static_cast<double>(raw); }
  /// Whether a physical value, rounded to the nearest code, is within the range.
  bool can_carry(double physical) const;
  /// The raw value nearest to a physical one, at the end of the range if it is beyond.
  std::int64_t nearest_raw(double physical) const;
  std::int64_t read(std::span<const std::uint8_t> data) const;
  void write(std::int64_t raw, std::span<std::uint8_t> data) const;
};

/// A frame of the map. Its first signals are the check (crc8 or crc16) and the counter. Those of a message that can be
/// authenticated end with `freshness`, `mac_low` and `mac_high`, which fill its last 12 bytes.
struct CanMessage {
  std::string name;
  std::string sender;
  std::uint32_t id = 0;       ///< 11 bits
  std::uint16_t data_id = 0;  ///< what the check covers beside the bytes (can_crc.hpp)
  bool fd = false;
  unsigned length = 0;    ///< bytes
  unsigned cycle_ms = 0;  ///< 0: not cyclic
  std::vector<CanSignal> signals;

  const CanSignal* find(std::string_view signal) const;
  /// Throws FileError if there is none.
  const CanSignal& at(std::string_view signal) const;
  unsigned crc_bits() const { return signals.front().length; }
  const CanSignal& counter() const { return signals[1]; }
  bool has_authentication() const { return find("freshness") != nullptr; }
  /// Whether the check in this data is right for this message.
  bool is_intact(std::span<const std::uint8_t> data) const;
  /// Puts the check in its place.
  void seal(std::span<std::uint8_t> data) const;
};

struct CanMap {
  std::vector<CanMessage> messages;

  const CanMessage* find(std::string_view message) const;
  /// Throws FileError, with the nearest name, if there is none.
  const CanMessage& at(std::string_view message) const;
  const CanMessage* find(std::uint32_t id, bool fd) const;
};

/// Makes the map of a DBC file (dbc.hpp). Throws FileError with file and line for what this project does not use (extended
/// ids, multiplexing, big-endian or floating-point signals, signals over 32 bits) and for what is wrong: a signal over
/// another one, a length no frame has, a message whose first two signals are not crc8 or crc16 and counter in their places,
/// or one without a data id (attribute E2EDataId), two whose data ids the check cannot distinguish.
CanMap read_can_map(std::string_view text, const std::filesystem::path& path);

/// The map that this build's firmware is made from.
const CanMap& own_can_map();

}  // namespace hotfire
