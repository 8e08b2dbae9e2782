// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/can_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/files/can/can_crc.hpp"
#include "tools/files/can/dbc.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

constexpr unsigned kLargestId = 0x7FF;
constexpr unsigned kMostBits = 32;
constexpr std::array<unsigned, 7> kLongLengths{12, 16, 20, 24, 32, 48, 64};
constexpr int kStandardFd = 14;  ///< VFrameFormat
constexpr std::array<std::string_view, 3> kAuthentication{"freshness", "mac_low", "mac_high"};
constexpr std::array<std::uint8_t, 2> kNoBytes{};  ///< a frame of nothing but its check

/// Takes from a DBC file what this project's frames are made of, and refuses the rest.
class MapMaker {
 public:
  explicit MapMaker(const Dbc& dbc) : dbc_(dbc) {}

  CanMap map() const {
    CanMap map;
    for (const DbcMessage& message : dbc_.messages) {
      map.messages.push_back(message_of(message));
      require_data_id(map, message);
    }
    return map;
  }

 private:
  [[noreturn]] void refuse(std::size_t line, const std::string& problem) const {
    throw FileError(fmt::format("{}:{}: {}", dbc_.path.string(), line, problem));
  }

  CanMessage message_of(const DbcMessage& declared) const {
    if (declared.id > kLargestId) {
      refuse(declared.line, fmt::format("{}: id {} of 29 bits; allowed: 0 to {}, 11 bits", declared.name,
                                        declared.id & ~kExtendedId, kLargestId));
    }
    if (declared.frame_format != 0 && declared.frame_format != kStandardFd) {
      refuse(declared.line, fmt::format("{}: VFrameFormat {}; allowed: 0 (StandardCAN), {} (StandardCAN_FD)", declared.name,
                                        declared.frame_format, kStandardFd));
    }
    CanMessage message;
    message.name = declared.name;
    message.sender = declared.sender;
    message.id = declared.id;
    message.data_id = static_cast<std::uint16_t>(declared.data_id);
    message.fd = declared.frame_format == kStandardFd;
    message.length = declared.length;
    message.cycle_ms = declared.cycle_ms;
    for (const DbcSignal& signal : declared.signals) {
      message.signals.push_back(signal_of(signal, message));
    }
    require_protection(message, declared.line);
    require_length(message, declared.line);
    require_authentication(message, declared.line);
    return message;
  }

  CanSignal signal_of(const DbcSignal& declared, const CanMessage& message) const {
    if (declared.big_endian) {
      refuse(declared.line, fmt::format("{}: big-endian; allowed: @1, little-endian", declared.name));
    }
    if (declared.is_multiplexer || declared.selected_by) {
      refuse(declared.line, fmt::format("{}: multiplexed; allowed: signals that every frame carries", declared.name));
    }
    if (declared.number == DbcNumber::single_precision || declared.number == DbcNumber::double_precision) {
      refuse(declared.line, fmt::format("{}: floating-point; allowed: an integer with a factor", declared.name));
    }
    if (declared.length > kMostBits) {
      refuse(declared.line, fmt::format("{}: {} bits; allowed: up to {}", declared.name, declared.length, kMostBits));
    }
    for (const CanSignal& other : message.signals) {
      if (declared.start < other.start + other.length && other.start < declared.start + declared.length) {
        refuse(declared.line, fmt::format("{}: has a bit of {}", declared.name, other.name));
      }
    }
    CanSignal signal;
    signal.name = declared.name;
    signal.start = declared.start;
    signal.length = declared.length;
    signal.is_signed = declared.number == DbcNumber::signed_integer;
    signal.factor = declared.factor;
    signal.offset = declared.offset;
    signal.unit = declared.unit;
    set_range(signal, declared);
    return signal;
  }

  void set_range(CanSignal& signal, const DbcSignal& declared) const {
    if (!(signal.factor > 0.0)) {
      refuse(declared.line, fmt::format("{}: factor {}; allowed: above 0", signal.name, signal.factor));
    }
    const std::int64_t codes = std::int64_t{1} << signal.length;
    const std::int64_t first = signal.is_signed ? -codes / 2 : 0;
    signal.lowest_raw = std::llround((declared.lowest - signal.offset) / signal.factor);
    signal.highest_raw = std::llround((declared.highest - signal.offset) / signal.factor);
    if (signal.lowest_raw < first || signal.highest_raw >= first + codes || signal.lowest_raw >= signal.highest_raw) {
      refuse(declared.line,
             fmt::format("{}: range {} to {}; allowed: within {} to {}, what its bits can carry", signal.name,
                         declared.lowest, declared.highest, signal.physical(first), signal.physical(first + codes - 1)));
    }
  }

  void require_protection(const CanMessage& message, std::size_t line) const {
    const auto is = [&](std::size_t i, std::string_view name, unsigned start, unsigned length) {
      const CanSignal& signal = message.signals[i];
      return signal.name == name && signal.start == start && signal.length == length && !signal.is_signed &&
             signal.factor == 1.0 && signal.offset == 0.0 && signal.highest_raw == (std::int64_t{1} << length) - 1;
    };
    if (message.signals.size() < 2 ||
        !((is(0, "crc8", 0, 8) && is(1, "counter", 8, 8)) || (is(0, "crc16", 0, 16) && is(1, "counter", 16, 8)))) {
      refuse(line, fmt::format("{}: not protected; a message begins with crc8 : 0|8@1+ and counter : 8|8@1+, or "
                               "crc16 : 0|16@1+ and counter : 16|8@1+",
                               message.name));
    }
  }

  /// The newest message of the map must not be taken for another one of it: the checks of their data ids alone are
  /// different, and so are those of any frame of theirs with the same bytes, the checks being linear.
  void require_data_id(const CanMap& map, const DbcMessage& declared) const {
    constexpr unsigned kLargestCanMap = 0xFFFF;
    if (declared.data_id == 0 || declared.data_id > kLargestCanMap) {
      refuse(declared.line, fmt::format("{}: data id {}; allowed: BA_ \"E2EDataId\" BO_ {} of 1 to {}", declared.name,
                                        declared.data_id, declared.id, kLargestCanMap));
    }
    const CanMessage& message = map.messages.back();
    for (const CanMessage& other : std::span(map.messages).first(map.messages.size() - 1)) {
      const CanCrc& crc = can_crc(message.crc_bits());
      if (other.crc_bits() == crc.bits && crc.of_frame(kNoBytes, message.data_id) == crc.of_frame(kNoBytes, other.data_id)) {
        refuse(declared.line,
               fmt::format("{}: data id {}, which a check of {} bits does not distinguish from {}, that of {}",
                           declared.name, message.data_id, crc.bits, other.data_id, other.name));
      }
    }
  }

  void require_authentication(const CanMessage& message, std::size_t line) const {
    const std::size_t count = message.signals.size();
    for (const CanSignal& signal : message.signals) {
      const auto place = std::find(kAuthentication.begin(), kAuthentication.end(), signal.name);
      if (place == kAuthentication.end() && !message.has_authentication()) {
        continue;
      }
      const auto index = static_cast<std::size_t>(&signal - message.signals.data());
      const bool is_behind = index + kAuthentication.size() >= count;
      if (is_behind != (place != kAuthentication.end())) {
        refuse_authentication(message, line);
      }
      if (!is_behind) {
        continue;
      }
      const auto number = static_cast<unsigned>(place - kAuthentication.begin());
      const unsigned start = 8 * message.length - kMostBits * (static_cast<unsigned>(kAuthentication.size()) - number);
      if (index + kAuthentication.size() != count + number || signal.start != start || signal.length != kMostBits ||
          signal.is_signed || signal.factor != 1.0 || signal.offset != 0.0 ||
          signal.highest_raw != (std::int64_t{1} << kMostBits) - 1) {
        refuse_authentication(message, line);
      }
    }
  }

  [[noreturn]] void refuse_authentication(const CanMessage& message, std::size_t line) const {
    refuse(line, fmt::format("{}: its authentication is not in its place; allowed: {}, |32@1+ each, as its last signals and "
                             "its last 12 bytes",
                             message.name, fmt::join(kAuthentication, ", ")));
  }

  void require_length(const CanMessage& message, std::size_t line) const {
    const bool is_long = std::find(kLongLengths.begin(), kLongLengths.end(), message.length) != kLongLengths.end();
    if (message.length > 8 && !(message.fd && is_long)) {
      refuse(line, fmt::format("{}: {} bytes; allowed: 0 to 8, and for FD {}", message.name, message.length,
                               fmt::join(kLongLengths, ", ")));
    }
  }

  const Dbc& dbc_;
};

}  // namespace

bool CanSignal::can_carry(double physical) const {
  const double raw = std::round((physical - offset) / factor);
  return raw >= static_cast<double>(lowest_raw) && raw <= static_cast<double>(highest_raw);
}

std::int64_t CanSignal::nearest_raw(double physical) const {
  const double raw = std::round((physical - offset) / factor);
  return static_cast<std::int64_t>(std::clamp(raw, static_cast<double>(lowest_raw), static_cast<double>(highest_raw)));
}

std::int64_t CanSignal::read(std::span<const std::uint8_t> data) const {
  std::int64_t raw = 0;
  for (unsigned bit = 0; bit < length; ++bit) {
    const unsigned at = start + bit;
    const bool is_sign = is_signed && bit == length - 1;
    const std::int64_t weight = std::int64_t{1} << bit;
    raw += ((data[at / 8] >> (at % 8)) & 1U) == 0 ? 0 : is_sign ? -weight : weight;
  }
  return raw;
}

void CanSignal::write(std::int64_t raw, std::span<std::uint8_t> data) const {
  const auto code = static_cast<std::uint64_t>(raw);
  for (unsigned bit = 0; bit < length; ++bit) {
    const unsigned at = start + bit;
    const auto mask = static_cast<std::uint8_t>(1U << (at % 8));
    data[at / 8] = static_cast<std::uint8_t>(((code >> bit) & 1U) != 0 ? data[at / 8] | mask : data[at / 8] & ~mask);
  }
}

const CanSignal* CanMessage::find(std::string_view signal) const {
  const auto found = std::find_if(signals.begin(), signals.end(), [signal](const CanSignal& s) { return s.name == signal; });
  return found == signals.end() ? nullptr : &*found;
}

bool CanMessage::is_intact(std::span<const std::uint8_t> data) const {
  return signals.front().read(data) == can_crc(crc_bits()).of_frame(data, data_id);
}

void CanMessage::seal(std::span<std::uint8_t> data) const {
  signals.front().write(can_crc(crc_bits()).of_frame(data, data_id), data);
}

const CanSignal& CanMessage::at(std::string_view signal) const {
  const CanSignal* found = find(signal);
  if (found == nullptr) {
    throw FileError(fmt::format("message {} of the CAN map has no signal {}", name, signal));
  }
  return *found;
}

const CanMessage* CanMap::find(std::string_view message) const {
  const auto found =
      std::find_if(messages.begin(), messages.end(), [message](const CanMessage& m) { return m.name == message; });
  return found == messages.end() ? nullptr : &*found;
}

const CanMessage& CanMap::at(std::string_view message) const {
  const CanMessage* found = find(message);
  if (found == nullptr) {
    std::vector<std::string_view> names;
    for (const CanMessage& known : messages) {
      names.push_back(known.name);
    }
    throw FileError(fmt::format("no message {} in the CAN map; {}", message, suggestion(std::string(message), names)));
  }
  return *found;
}

const CanMessage* CanMap::find(std::uint32_t id, bool fd) const {
  const auto found =
      std::find_if(messages.begin(), messages.end(), [=](const CanMessage& m) { return m.id == id && m.fd == fd; });
  return found == messages.end() ? nullptr : &*found;
}

CanMap read_can_map(std::string_view text, const std::filesystem::path& path) {
  return MapMaker(read_dbc(text, path)).map();
}

}  // namespace hotfire
