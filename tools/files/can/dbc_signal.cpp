// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tools/files/can/dbc.hpp"

namespace hotfire {

std::uint64_t DbcSignal::raw(std::span<const std::uint8_t> data) const {
  std::uint64_t bits = 0;
  for (unsigned i = 0; i < length; ++i) {  // from the highest bit on
    const unsigned at = big_endian ? ((start ^ 7U) + i) ^ 7U : start + length - 1 - i;
    bits = (bits << 1U) | ((data[at / 8] >> (at % 8)) & 1U);
  }
  return bits;
}

double DbcSignal::physical(std::span<const std::uint8_t> data) const {
  constexpr unsigned kBits = 64;
  const std::uint64_t bits = raw(data);
  switch (number) {
    case DbcNumber::signed_integer:  // shifted up and down again, which repeats the sign
      return offset + factor * static_cast<double>(static_cast<std::int64_t>(bits << (kBits - length)) >> (kBits - length));
    case DbcNumber::single_precision:
      return offset + factor * static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case DbcNumber::double_precision:
      return offset + factor * std::bit_cast<double>(bits);
    case DbcNumber::unsigned_integer:
      break;
  }
  return offset + factor * static_cast<double>(bits);
}

bool DbcSignal::allows(double physical) const {
  const bool is_integer = number == DbcNumber::unsigned_integer || number == DbcNumber::signed_integer;
  const double rounding = is_integer ? 0.5 * std::abs(factor)
                                     : static_cast<double>(std::numeric_limits<float>::epsilon()) *
                                           std::max(std::abs(lowest), std::abs(highest));
  return std::isfinite(physical) && (lowest == highest || (physical >= lowest - rounding && physical <= highest + rounding));
}

const DbcSignal* DbcMessage::find(std::string_view signal) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const DbcSignal& s) { return s.name == signal; });
  return found == signals.end() ? nullptr : &*found;
}

const DbcSignal* DbcMessage::multiplexer() const {
  const auto found = std::find_if(signals.begin(), signals.end(), [](const DbcSignal& s) { return s.is_multiplexer; });
  return found == signals.end() ? nullptr : &*found;
}

const DbcMessage* Dbc::find(std::string_view message) const {
  const auto found = std::find_if(messages.begin(), messages.end(), [&](const DbcMessage& m) { return m.name == message; });
  return found == messages.end() ? nullptr : &*found;
}

}  // namespace hotfire
