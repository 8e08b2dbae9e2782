#include "tools/files/can_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "tools/files/can_crc.hpp"
#include "tools/files/error.hpp"
#include "tools/files/suggestion.hpp"

namespace hotfire {

namespace {

constexpr std::uint32_t kExtended = 0x80000000;
constexpr unsigned kLargestId = 0x7FF;
constexpr std::array<unsigned, 7> kLongLengths{12, 16, 20, 24, 32, 48, 64};
constexpr int kStandardFd = 14;  ///< VFrameFormat

/// Reads the lines of a DBC file that say what frames look like; the others (comments, units of other tools) are left out.
class DbcReader {
 public:
  DbcReader(std::string_view text, const std::filesystem::path& path) : text_(text), path_(path) {}

  CanMap read() {
    while (next_line()) {
      if (line_.starts_with("BO_ ")) {
        read_message();
      } else if (line_.find(" SG_ ") != std::string::npos && line_.find_first_not_of(' ') == line_.find("SG_ ")) {
        read_signal();
      } else if (line_.starts_with("BA_ ")) {
        read_attribute();
      } else if (line_.starts_with("SIG_VALTYPE_ ")) {
        refuse("floating-point signals are not used; give the signal a factor");
      }
    }
    for (const CanMessage& message : map_.messages) {
      require_protection(message);
      require_length(message);
    }
    return std::move(map_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw FileError(fmt::format("{}:{}: {}", path_.string(), number_, problem));
  }

  bool next_line() {
    if (text_.empty()) {
      return false;
    }
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line_ = std::string(text_.substr(0, end));
    if (line_.ends_with('\r')) {
      line_.pop_back();
    }
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++number_;
    return true;
  }

  void read_message() {
    static const std::regex form(R"re(BO_ (\d{1,10}) (\w+) ?: (\d{1,3}) (\w+)\s*)re");
    std::smatch parts;
    if (!std::regex_match(line_, parts, form)) {
      refuse("not a message; allowed: BO_ id name: length sender");
    }
    const unsigned long id = std::stoul(parts[1]);
    if (id > kLargestId) {
      refuse(fmt::format("{}: id {}{}; allowed: 0 to {}, 11 bits", parts[2].str(), id & ~std::uint64_t{kExtended},
                         (id & kExtended) != 0 ? " of 29 bits" : "", kLargestId));
    }
    CanMessage message;
    message.name = parts[2];
    message.id = static_cast<std::uint32_t>(id);
    message.length = static_cast<unsigned>(std::stoul(parts[3]));
    message.sender = parts[4];
    if (map_.find(message.name) != nullptr ||
        std::any_of(map_.messages.begin(), map_.messages.end(), [&](const auto& m) { return m.id == message.id; })) {
      refuse(fmt::format("{}: its name or its id {} is used before", message.name, message.id));
    }
    map_.messages.push_back(std::move(message));
  }

  void read_signal() {
    static const std::regex form(
        R"re(\s*SG_ (\w+) ?: (\d{1,3})\|(\d{1,2})@([01])([+-]) \(([^,]+),([^)]+)\) \[([^|]+)\|([^\]]+)\] "([^"]*)" .*)re");
    std::smatch parts;
    if (map_.messages.empty() || !std::regex_match(line_, parts, form)) {
      refuse(
          "not a signal; allowed: SG_ name : start|length@1+ (factor,offset) [lowest|highest] \"unit\" receivers, below a "
          "message, not multiplexed");
    }
    CanMessage& message = map_.messages.back();
    CanSignal signal;
    signal.name = parts[1];
    signal.start = static_cast<unsigned>(std::stoul(parts[2]));
    signal.length = static_cast<unsigned>(std::stoul(parts[3]));
    signal.is_signed = parts[5] == "-";
    signal.factor = number(parts[6]);
    signal.offset = number(parts[7]);
    signal.unit = parts[10];
    if (parts[4] == "0") {
      refuse(fmt::format("{}: big-endian; allowed: @1, little-endian", signal.name));
    }
    if (signal.length == 0 || signal.length > 32 || signal.start + signal.length > 8 * message.length) {
      refuse(fmt::format("{}: bits {} to {} of a frame of {}; allowed: up to 32 bits inside it", signal.name, signal.start,
                         signal.start + signal.length - 1, 8 * message.length));
    }
    for (const CanSignal& other : message.signals) {
      if (other.name == signal.name ||
          (signal.start < other.start + other.length && other.start < signal.start + signal.length)) {
        refuse(fmt::format("{}: has the name or a bit of {}", signal.name, other.name));
      }
    }
    set_range(signal, number(parts[8]), number(parts[9]));
    message.signals.push_back(std::move(signal));
  }

  void set_range(CanSignal& signal, double lowest, double highest) const {
    if (!(signal.factor > 0.0)) {
      refuse(fmt::format("{}: factor {}; allowed: above 0", signal.name, signal.factor));
    }
    const std::int64_t codes = std::int64_t{1} << signal.length;
    const std::int64_t first = signal.is_signed ? -codes / 2 : 0;
    signal.lowest_raw = std::llround((lowest - signal.offset) / signal.factor);
    signal.highest_raw = std::llround((highest - signal.offset) / signal.factor);
    if (signal.lowest_raw < first || signal.highest_raw >= first + codes || signal.lowest_raw >= signal.highest_raw) {
      refuse(fmt::format("{}: range {} to {}; allowed: within {} to {}, what its bits can carry", signal.name, lowest,
                         highest, signal.physical(first), signal.physical(first + codes - 1)));
    }
  }

  void read_attribute() {
    static const std::regex form(R"re(BA_ "(\w+)" BO_ (\d{1,10}) (\d{1,9});\s*)re");
    std::smatch parts;
    if (!std::regex_match(line_, parts, form)) {
      return;
    }
    const unsigned long id = std::stoul(parts[2]);
    const int value = std::stoi(parts[3]);
    const auto message =
        std::find_if(map_.messages.begin(), map_.messages.end(), [id](const CanMessage& m) { return m.id == id; });
    if (message == map_.messages.end()) {
      refuse(fmt::format("an attribute of message {}, which is none", id));
    }
    if (parts[1] == "VFrameFormat") {
      if (value != 0 && value != kStandardFd) {
        refuse(fmt::format("{}: VFrameFormat {}; allowed: 0 (StandardCAN), {} (StandardCAN_FD)", message->name, value,
                           kStandardFd));
      }
      message->fd = value == kStandardFd;
    } else if (parts[1] == "GenMsgCycleTime") {
      message->cycle_ms = static_cast<unsigned>(value);
    }
  }

  double number(const std::string& text) const {
    try {
      std::size_t end = 0;
      const double value = std::stod(text, &end);
      if (end == text.size() && std::isfinite(value)) {
        return value;
      }
    } catch (const std::exception&) {
      // said below
    }
    refuse(fmt::format("\"{}\" is no number", text));
  }

  void require_protection(const CanMessage& message) const {
    const auto is = [&](std::size_t i, std::string_view name, unsigned start, unsigned length) {
      const CanSignal& signal = message.signals[i];
      return signal.name == name && signal.start == start && signal.length == length && !signal.is_signed &&
             signal.factor == 1.0 && signal.offset == 0.0 && signal.highest_raw == (std::int64_t{1} << length) - 1;
    };
    if (message.signals.size() < 2 ||
        !((is(0, "crc8", 0, 8) && is(1, "counter", 8, 8)) || (is(0, "crc16", 0, 16) && is(1, "counter", 16, 8)))) {
      throw FileError(
          fmt::format("{}: {}: not protected; a message begins with crc8 : 0|8@1+ and counter : 8|8@1+, or "
                      "crc16 : 0|16@1+ and counter : 16|8@1+",
                      path_.string(), message.name));
    }
  }

  void require_length(const CanMessage& message) const {
    const bool is_long = std::find(kLongLengths.begin(), kLongLengths.end(), message.length) != kLongLengths.end();
    if (message.length > 8 && !(message.fd && is_long)) {
      throw FileError(fmt::format("{}: {}: {} bytes; allowed: 0 to 8, and for FD {}", path_.string(), message.name,
                                  message.length, fmt::join(kLongLengths, ", ")));
    }
  }

  std::string_view text_;
  std::filesystem::path path_;
  std::string line_;
  std::size_t number_ = 0;
  CanMap map_;
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
  return signals.front().read(data) == can_crc(crc_bits()).of_frame(data, id);
}

void CanMessage::seal(std::span<std::uint8_t> data) const {
  signals.front().write(can_crc(crc_bits()).of_frame(data, id), data);
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

CanMap read_can_map(std::string_view text, const std::filesystem::path& path) { return DbcReader(text, path).read(); }

}  // namespace hotfire
