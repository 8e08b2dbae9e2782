// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace hotfire {

/// The two checks of the CAN map, bit by bit, most significant bit first, without reflection. Both run over the bytes behind
/// the check, then over the message's data id, low byte first (AUTOSAR, Specification of E2E Protocol, profile 5). The data
/// id is not in the frame: who takes a message for another one finds a wrong check, whatever the frame's CAN id is.
/// - 8 bits: CRC-8/SAE-J1850, polynomial 0x1D, start and final exclusive-or 0xFF. Check value 0x4B for "123456789".
/// - 16 bits: CRC-16/IBM-3740 (CCITT-FALSE), polynomial 0x1021, start 0xFFFF. Check value 0x29B1.
struct CanCrc {
  unsigned bits;
  std::uint16_t polynomial;
  std::uint16_t start;
  std::uint16_t final_xor;

  /// The check after one more byte.
  constexpr std::uint16_t add(std::uint16_t crc, std::uint8_t byte) const {
    const unsigned top = 1U << (bits - 1);
    unsigned value = crc ^ (static_cast<unsigned>(byte) << (bits - 8));
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & top) != 0 ? (value << 1) ^ polynomial : value << 1;
    }
    return static_cast<std::uint16_t>(value & ((1U << bits) - 1));
  }

  /// Of a frame's data, whose first `bits` are the place of the check itself.
  constexpr std::uint16_t of_frame(std::span<const std::uint8_t> data, std::uint16_t data_id) const {
    std::uint16_t crc = start;
    for (const std::uint8_t byte : data.subspan(bits / 8)) {
      crc = add(crc, byte);
    }
    crc = add(crc, static_cast<std::uint8_t>(data_id));
    crc = add(crc, static_cast<std::uint8_t>(data_id >> 8));
    return crc ^ final_xor;
  }
};

inline constexpr CanCrc kCanCrc8{8, 0x1D, 0xFF, 0xFF};
inline constexpr CanCrc kCanCrc16{16, 0x1021, 0xFFFF, 0x0000};

constexpr const CanCrc& can_crc(unsigned bits) { return bits == 8 ? kCanCrc8 : kCanCrc16; }

}  // namespace hotfire
