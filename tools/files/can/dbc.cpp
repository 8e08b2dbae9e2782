#include "tools/files/can/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <regex>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr unsigned kLargestBaseId = 0x7FF;
constexpr unsigned kLargestExtendedId = 0x1FFFFFFF;
/// CANdb++ keeps signals of no frame in a message of this id and no bytes, which nobody sends.
constexpr std::uint32_t kNoFrame = 0xC0000000;

class DbcReader {
 public:
  DbcReader(std::string_view text, const std::filesystem::path& path) : text_(text) { dbc_.path = path; }

  Dbc read() {
    while (next_statement()) {
      const std::size_t first = line_.find_first_not_of(" \t");
      const std::string_view statement = std::string_view(line_).substr(std::min(first, line_.size()));
      if (statement.starts_with("BO_ ")) {
        read_message();
      } else if (statement.starts_with("SG_ ")) {
        read_signal();
      } else if (statement.starts_with("BA_ ")) {
        read_attribute();
      } else if (statement.starts_with("SIG_VALTYPE_ ")) {
        read_number_type();
      } else if (statement.starts_with("SG_MUL_VAL_ ")) {
        read_multiplexing();
      }
    }
    if (dbc_.messages.empty()) {
      throw FileError(
          fmt::format("{}: no message; a DBC file has lines like BO_ 256 COMMAND: 8 Controller", dbc_.path.string()));
    }
    return std::move(dbc_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw FileError(fmt::format("{}:{}: {}", dbc_.path.string(), number_, problem));
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

  /// The next line that is not the rest of a comment of several lines, which may read like a statement.
  bool next_statement() {
    while (next_line()) {
      const bool inside = text_from_ != 0;
      for (std::size_t i = 0; i < line_.size(); ++i) {
        if (line_[i] == '"' && (i == 0 || line_[i - 1] != '\\')) {
          text_from_ = text_from_ != 0 ? 0 : number_;
        }
      }
      if (!inside) {
        return true;
      }
    }
    if (text_from_ != 0) {
      number_ = text_from_;
      refuse("a text begins here that never ends; close it with \"");
    }
    return false;
  }

  void read_message() {
    std::smatch parts;
    if (!std::regex_match(line_, parts, message_form_)) {
      refuse("not a message; allowed: BO_ id name: length sender");
    }
    DbcMessage message;
    message.name = parts[2];
    message.line = number_;
    message.id = id_of(parts[1]);
    message.length = static_cast<unsigned>(std::stoul(parts[3]));
    message.sender = parts[4];
    const std::uint32_t largest = (message.id & kExtendedId) != 0 ? kLargestExtendedId : kLargestBaseId;
    if ((message.id & ~kExtendedId) > largest && message.id != kNoFrame) {
      refuse(fmt::format("{}: id {}; allowed: 0 to {}, or {} to {} for 29 bits", message.name, message.id, kLargestBaseId,
                         kExtendedId, kExtendedId + kLargestExtendedId));
    }
    if (dbc_.find(message.name) != nullptr || with_id(message.id) != nullptr) {
      refuse(fmt::format("{}: its name or its id {} is used before", message.name, message.id));
    }
    dbc_.messages.push_back(std::move(message));
  }

  void read_signal() {
    const std::size_t unit = line_.find('"');
    const std::string head = line_.substr(0, line_.find('"', std::min(unit, line_.size() - 1) + 1));  // not the receivers
    std::smatch parts;
    if (dbc_.messages.empty() || !std::regex_match(head, parts, signal_form_)) {
      refuse(
          "not a signal; allowed: SG_ name : start|length@1+ (factor,offset) [lowest|highest] \"unit\" receivers, below a "
          "message; @0 is big-endian, @1- signed, M or m0 behind the name multiplexed");
    }
    DbcMessage& message = dbc_.messages.back();
    DbcSignal signal;
    signal.name = parts[1];
    signal.line = number_;
    signal.is_multiplexer = parts[2] == "M";
    if (parts[3].matched) {
      signal.selected_by = std::stoull(parts[3]);
    }
    message.has_extended_multiplexing = message.has_extended_multiplexing || parts[4] == "M";
    signal.start = static_cast<unsigned>(std::stoul(parts[5]));
    signal.length = static_cast<unsigned>(std::stoul(parts[6]));
    signal.big_endian = parts[7] == "0";
    signal.number = parts[8] == "-" ? DbcNumber::signed_integer : DbcNumber::unsigned_integer;
    signal.factor = number(parts[9]);
    signal.offset = number(parts[10]);
    signal.lowest = number(parts[11]);
    signal.highest = number(parts[12]);
    signal.unit = parts[13];
    require_sound(message, signal);
    message.signals.push_back(std::move(signal));
  }

  void require_sound(const DbcMessage& message, const DbcSignal& signal) const {
    constexpr unsigned kLongestSignal = 64;
    if (message.find(signal.name) != nullptr) {
      refuse(fmt::format("{}: the message has this signal before", signal.name));
    }
    // A big-endian signal goes on from its highest bit towards bit 0 of its byte, then to bit 7 of the next.
    const unsigned first = signal.big_endian ? signal.start ^ 7U : signal.start;
    if (signal.length == 0 || signal.length > kLongestSignal ||
        (first + signal.length > 8 * message.length && message.id != kNoFrame)) {
      refuse(fmt::format("{}: bits {} to {} of a frame of {}; allowed: up to {} bits inside it", signal.name, first,
                         first + signal.length - 1, 8 * message.length, kLongestSignal));
    }
    if (signal.factor == 0.0) {
      refuse(fmt::format("{}: factor 0; allowed: any other number", signal.name));
    }
    if (signal.lowest > signal.highest) {
      refuse(fmt::format("{}: range {} to {}; allowed: the lower end first, [0|0] for no range", signal.name, signal.lowest,
                         signal.highest));
    }
  }

  void read_attribute() {
    std::smatch parts;
    if (!std::regex_match(line_, parts, attribute_form_)) {
      return;
    }
    DbcMessage& message = declared(parts[2]);
    if (parts[1] == "VFrameFormat") {
      message.frame_format = std::stoi(parts[3]);
    } else if (parts[1] == "GenMsgCycleTime") {
      message.cycle_ms = static_cast<unsigned>(std::stoul(parts[3]));
    } else if (parts[1] == "E2EDataId") {
      message.data_id = static_cast<unsigned>(std::stoul(parts[3]));
    }
  }

  void read_number_type() {
    std::smatch parts;
    if (!std::regex_match(line_, parts, number_type_form_)) {
      refuse("not the type of a signal; allowed: SIG_VALTYPE_ id signal : 0; (integer), 1; (single), 2; (double precision)");
    }
    DbcMessage& message = declared(parts[1]);
    const auto signal = std::find_if(message.signals.begin(), message.signals.end(),
                                     [&](const DbcSignal& known) { return known.name == parts[2]; });
    if (signal == message.signals.end()) {
      refuse(fmt::format("{} has no signal {}", message.name, parts[2].str()));
    }
    if (parts[3] == "0") {
      return;
    }
    const bool is_single = parts[3] == "1";
    if (signal->length != (is_single ? 32U : 64U)) {
      refuse(fmt::format("{}: {} bits; allowed: 32 for single, 64 for double precision", signal->name, signal->length));
    }
    signal->number = is_single ? DbcNumber::single_precision : DbcNumber::double_precision;
  }

  void read_multiplexing() {
    std::smatch parts;
    if (!std::regex_match(line_, parts, multiplexing_form_)) {
      refuse("not multiplexing; allowed: SG_MUL_VAL_ id signal multiplexer ranges;");
    }
    declared(parts[1]).has_extended_multiplexing = true;
  }

  std::uint32_t id_of(const std::string& text) const {
    const unsigned long long id = std::stoull(text);
    if (id > UINT32_MAX) {
      refuse(fmt::format("id {}; allowed: 0 to {}", text, UINT32_MAX));
    }
    return static_cast<std::uint32_t>(id);
  }

  DbcMessage* with_id(std::uint32_t id) {
    const auto found =
        std::find_if(dbc_.messages.begin(), dbc_.messages.end(), [id](const DbcMessage& m) { return m.id == id; });
    return found == dbc_.messages.end() ? nullptr : &*found;
  }

  DbcMessage& declared(const std::string& id) {
    DbcMessage* message = with_id(id_of(id));
    if (message == nullptr) {
      refuse(fmt::format("of message {}, which is none", id));
    }
    return *message;
  }

  double number(const std::string& text) const {
    try {
      std::size_t end = 0;
      const double value = std::stod(text, &end);
      if (text.find_first_not_of(' ', end) == std::string::npos && std::isfinite(value)) {
        return value;
      }
    } catch (const std::exception&) {
      // said below
    }
    refuse(fmt::format("\"{}\" is no number", text));
  }

  const std::regex message_form_{R"re(\s*BO_ +(\d{1,10}) +(\w+) *: *(\d{1,4}) +(\w+)\s*)re"};
  const std::regex signal_form_{
      R"re(\s*SG_ +(\w+) *(M|m(\d{1,10})(M?))? *: *(\d{1,4})\|(\d{1,4})@([01])([+-]) *\(([^,]+),([^)]+)\) *\[([^|]+)\|([^\]]+)\] *"([^"]*))re"};
  const std::regex attribute_form_{R"re(\s*BA_ +"(\w+)" +BO_ +(\d{1,10}) +(\d{1,9}) *;\s*)re"};
  const std::regex number_type_form_{R"re(\s*SIG_VALTYPE_ +(\d{1,10}) +(\w+) *:? *([0-2]) *;\s*)re"};
  const std::regex multiplexing_form_{R"re(\s*SG_MUL_VAL_ +(\d{1,10}) +(\w+) +(\w+) +[^;]+;\s*)re"};
  std::string_view text_;
  std::string line_;
  std::size_t number_ = 0;
  std::size_t text_from_ = 0;  ///< line on which a text begins that has not ended, 0: none
  Dbc dbc_;
};

}  // namespace

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

Dbc read_dbc(std::string_view text, const std::filesystem::path& path) { return DbcReader(text, path).read(); }

Dbc load_dbc(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("{}: cannot be opened; allowed: a DBC file", path.string()));
  }
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return read_dbc(text, path);
}

}  // namespace hotfire
