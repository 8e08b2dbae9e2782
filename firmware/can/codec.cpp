// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/codec.hpp"

#include <cmath>

#include "firmware/can/can_map.hpp"

namespace hotfire::firmware::can {
namespace {

/// The bytes behind the check, then the data id, low byte first (tools/files/can/can_crc.hpp has the law that the tables are
/// made from).
template <class Crc>
Crc check_of(const std::array<Crc, 256>& table, Crc start, Crc final_xor, std::span<const std::uint8_t> bytes,
             std::uint16_t data_id) noexcept {
  constexpr unsigned kShift = 8 * (sizeof(Crc) - 1);
  unsigned crc = start;
  const auto add = [&](std::uint8_t byte) { crc = table[((crc >> kShift) ^ byte) & 0xFF] ^ (kShift == 0 ? 0 : crc << 8); };
  for (const std::uint8_t byte : bytes) {
    add(byte);
  }
  add(static_cast<std::uint8_t>(data_id));
  add(static_cast<std::uint8_t>(data_id >> 8));
  return static_cast<Crc>(crc ^ final_xor);
}

std::uint16_t check_of(const Message& message, std::span<const std::uint8_t> data) noexcept {
  const auto behind = data.subspan(message.crc_bits / 8);
  return message.crc_bits == 8 ? check_of(kCrc8, kCrc8Start, kCrc8FinalXor, behind, message.data_id)
                               : check_of(kCrc16, kCrc16Start, kCrc16FinalXor, behind, message.data_id);
}

std::uint16_t check_in(const Message& message, std::span<const std::uint8_t> data) noexcept {
  return static_cast<std::uint16_t>(data[0] | (message.crc_bits == 16 ? data[1] << 8 : 0));
}

std::int64_t raw_of(const Signal& signal, std::span<const std::uint8_t> data) noexcept {
  const unsigned first = signal.start / 8;
  const unsigned last = (signal.start + signal.length - 1U) / 8;
  std::uint64_t bits = 0;
  for (unsigned byte = last + 1; byte > first; --byte) {
    bits = bits << 8 | data[byte - 1];
  }
  const std::uint64_t mask = (std::uint64_t{1} << signal.length) - 1;
  const auto code = static_cast<std::int64_t>((bits >> signal.start % 8) & mask);
  const bool negative = signal.is_signed && (code >> (signal.length - 1)) != 0;
  return negative ? code - static_cast<std::int64_t>(mask) - 1 : code;
}

/// Into bits that are zero.
void set_raw(const Signal& signal, std::int64_t raw, std::span<std::uint8_t> data) noexcept {
  const std::uint64_t mask = (std::uint64_t{1} << signal.length) - 1;
  std::uint64_t bits = (static_cast<std::uint64_t>(raw) & mask) << signal.start % 8;
  for (unsigned byte = signal.start / 8; bits != 0; ++byte, bits >>= 8) {
    data[byte] = static_cast<std::uint8_t>(data[byte] | (bits & 0xFF));
  }
}

bool in_range(const Signal& signal, std::int64_t raw) noexcept {
  return raw >= signal.lowest_raw && raw <= signal.highest_raw;
}

}  // namespace

Decoding decode(const Message& message, const hal::CanFrame& frame, std::span<double> values,
                std::uint8_t& counter) noexcept {
  if (frame.id != hal::CanId{message.id, false}) {
    return Decoding::wrong_id;
  }
  if (frame.fd != message.fd) {
    return Decoding::wrong_format;
  }
  if (frame.length != message.length) {
    return Decoding::wrong_length;
  }
  const auto data = frame.bytes();
  if (check_in(message, data) != check_of(message, data)) {
    return Decoding::wrong_crc;
  }
  for (const Signal& signal : message.signals) {
    if (!in_range(signal, raw_of(signal, data))) {
      return Decoding::out_of_range;
    }
  }
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const Signal& signal = message.signals[i];
    values[i] = signal.offset + signal.factor * static_cast<double>(raw_of(signal, data));
  }
  counter = data[message.crc_bits / 8];
  return Decoding::good;
}

bool encode(const Message& message, std::span<const double> values, std::uint8_t counter, hal::CanFrame& frame) noexcept {
  hal::CanFrame made;
  made.id = {message.id, false};
  made.fd = message.fd;
  made.bit_rate_switch = message.fd;
  made.length = message.length;
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const Signal& signal = message.signals[i];
    const double code = std::round((values[i] - signal.offset) / signal.factor);
    if (!(std::abs(code) <= 0x1p32) || !in_range(signal, static_cast<std::int64_t>(code))) {
      return false;
    }
    set_raw(signal, static_cast<std::int64_t>(code), made.data);
  }
  made.data[message.crc_bits / 8] = counter;
  put_check(message, made);
  frame = made;
  return true;
}

void put_check(const Message& message, hal::CanFrame& frame) noexcept {
  const std::uint16_t check = check_of(message, frame.bytes());
  frame.data[0] = static_cast<std::uint8_t>(check);
  if (message.crc_bits == 16) {
    frame.data[1] = static_cast<std::uint8_t>(check >> 8);
  }
}

}  // namespace hotfire::firmware::can
