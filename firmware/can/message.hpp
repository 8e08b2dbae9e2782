// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace hotfire::firmware::can {

/// A number in a frame: `physical = offset + factor raw`, raw little-endian from bit `start` on, at most 32 bits.
struct Signal {
  std::string_view name;
  std::uint16_t start;
  std::uint8_t length;
  bool is_signed;
  double factor;
  double offset;
  std::int64_t lowest_raw;  ///< both ends of what may be sent
  std::int64_t highest_raw;
};

/// A frame of the CAN map. It begins with a check of 8 or 16 bits and a counter of 8, and one that can be authenticated ends
/// with freshness and authentication code (authentication.hpp); `signals` leaves all of them out.
struct Message {
  std::string_view name;
  std::uint32_t id;       ///< 11 bits
  std::uint16_t data_id;  ///< what the check covers beside the bytes of the frame: which message it is
  bool fd;
  bool can_be_authenticated;
  std::uint8_t length;    ///< bytes
  std::uint8_t crc_bits;  ///< 8 or 16
  std::uint32_t cycle_ms;
  std::span<const Signal> signals;
};

}  // namespace hotfire::firmware::can
