// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "tools/files/can/dbc_line.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr unsigned kLargestBaseId = 0x7FF;
constexpr unsigned kLargestExtendedId = 0x1FFFFFFF;
/// CANdb++ keeps signals of no frame in a message of this id and no bytes, which nobody sends.
constexpr std::uint32_t kNoFrame = 0xC0000000;
/// Far above any real file, so that reading one takes a bounded time and memory.
constexpr std::size_t kLargestDbcFile = std::size_t{16} << 20;
constexpr std::size_t kLongestLine = std::size_t{64} << 10;
constexpr std::size_t kMostMessages = 10'000;
constexpr std::size_t kMostSignals = 1024;  ///< of a message

class DbcReader {
 public:
  DbcReader(std::string_view text, const std::filesystem::path& path) : text_(text) {
    dbc_.path = path;
    if (text.size() > kLargestDbcFile) {
      throw FileError(
          fmt::format("{}:1: over {} bytes; allowed: a DBC file of at most so many", path.string(), kLargestDbcFile));
    }
  }

  Dbc read() {
    while (next_statement()) {
      DbcLine line(line_);
      line.blanks();
      if (line.maybe("BO_ ")) {
        read_message(line);
      } else if (line.maybe("SG_ ")) {
        read_signal(line);
      } else if (line.maybe("BA_ ")) {
        read_attribute(line);
      } else if (line.maybe("SIG_VALTYPE_ ")) {
        read_number_type(line);
      } else if (line.maybe("SG_MUL_VAL_ ")) {
        read_multiplexing(line);
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
    line_ = text_.substr(0, end);
    ++number_;
    if (end > kLongestLine) {
      refuse(fmt::format("a line of {} characters; allowed: up to {}", end, kLongestLine));
    }
    if (line_.ends_with('\r')) {
      line_.remove_suffix(1);
    }
    text_.remove_prefix(std::min(end + 1, text_.size()));
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

  void read_message(DbcLine& line) {
    DbcMessage message;
    message.line = number_;
    line.blanks();
    const std::string id = line.digits(10);
    line.gap();
    message.name = line.word();
    line.blanks();
    line.expect(":");
    line.blanks();
    const std::string length = line.digits(4);
    line.gap();
    message.sender = line.word();
    if (!line.whole()) {
      refuse("not a message; allowed: BO_ id name: length sender");
    }
    message.id = id_of(id);
    message.length = static_cast<unsigned>(std::stoul(length));
    const std::uint32_t largest = (message.id & kExtendedId) != 0 ? kLargestExtendedId : kLargestBaseId;
    if ((message.id & ~kExtendedId) > largest && message.id != kNoFrame) {
      refuse(fmt::format("{}: id {}; allowed: 0 to {}, or {} to {} for 29 bits", message.name, message.id, kLargestBaseId,
                         kExtendedId, kExtendedId + kLargestExtendedId));
    }
    if (dbc_.find(message.name) != nullptr || with_id(message.id) != nullptr) {
      refuse(fmt::format("{}: its name or its id {} is used before", message.name, message.id));
    }
    if (dbc_.messages.size() == kMostMessages) {
      refuse(fmt::format("more than {} messages; cut the file into parts", kMostMessages));
    }
    dbc_.messages.push_back(std::move(message));
  }

  /// The bits and numbers of a signal, as they are written.
  struct SignalText {
    std::string selected_by, start, length, factor, offset, lowest, highest;
    char byte_order = '\0';
    char sign = '\0';
    bool is_multiplexed_multiplexer = false;
  };

  static void read_signal_text(DbcLine& line, DbcSignal& signal, SignalText& text) {
    line.blanks();
    signal.name = line.word();
    line.blanks();
    if (line.maybe("M")) {
      signal.is_multiplexer = true;
    } else if (line.maybe("m")) {
      text.selected_by = line.digits(10);
      text.is_multiplexed_multiplexer = line.maybe("M");
    }
    line.blanks();
    line.expect(":");
    line.blanks();
    text.start = line.digits(4);
    line.expect("|");
    text.length = line.digits(4);
    line.expect("@");
    text.byte_order = line.one_of("01");
    text.sign = line.one_of("+-");
    line.blanks();
    line.expect("(");
    text.factor = line.up_to(',');
    text.offset = line.up_to(')');
    line.blanks();
    line.expect("[");
    text.lowest = line.up_to('|');
    text.highest = line.up_to(']');
    line.blanks();
    line.expect("\"");
    signal.unit = line.up_to('"');  // the receivers follow
  }

  void read_signal(DbcLine& line) {
    DbcSignal signal;
    SignalText text;
    read_signal_text(line, signal, text);
    if (dbc_.messages.empty() || !line.good()) {
      refuse(
          "not a signal; allowed: SG_ name : start|length@1+ (factor,offset) [lowest|highest] \"unit\" receivers, below a "
          "message; @0 is big-endian, @1- signed, M or m0 behind the name multiplexed");
    }
    DbcMessage& message = dbc_.messages.back();
    signal.line = number_;
    if (!text.selected_by.empty()) {
      signal.selected_by = std::stoull(text.selected_by);
    }
    message.has_extended_multiplexing = message.has_extended_multiplexing || text.is_multiplexed_multiplexer;
    signal.start = static_cast<unsigned>(std::stoul(text.start));
    signal.length = static_cast<unsigned>(std::stoul(text.length));
    signal.big_endian = text.byte_order == '0';
    signal.number = text.sign == '-' ? DbcNumber::signed_integer : DbcNumber::unsigned_integer;
    signal.factor = number(text.factor);
    signal.offset = number(text.offset);
    signal.lowest = number(text.lowest);
    signal.highest = number(text.highest);
    require_sound(message, signal);
    if (message.signals.size() == kMostSignals) {
      refuse(fmt::format("{}: more than {} signals; cut the message into parts", message.name, kMostSignals));
    }
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

  void read_attribute(DbcLine& line) {
    line.blanks();
    line.expect("\"");
    const std::string name = line.word();
    line.expect("\"");
    line.gap();
    line.expect("BO_ ");
    line.blanks();
    const std::string id = line.digits(10);
    line.gap();
    const std::string value = line.digits(9);
    line.blanks();
    line.expect(";");
    if (!line.whole()) {
      return;  // of a signal, a node or the network, or a text
    }
    DbcMessage& message = declared(id);
    if (name == "VFrameFormat") {
      message.frame_format = std::stoi(value);
    } else if (name == "GenMsgCycleTime") {
      message.cycle_ms = static_cast<unsigned>(std::stoul(value));
    } else if (name == "E2EDataId") {
      message.data_id = static_cast<unsigned>(std::stoul(value));
    }
  }

  void read_number_type(DbcLine& line) {
    line.blanks();
    const std::string id = line.digits(10);
    line.gap();
    const std::string name = line.word();
    line.blanks();
    line.maybe(":");
    line.blanks();
    const char type = line.one_of("012");
    line.blanks();
    line.expect(";");
    if (!line.whole()) {
      refuse("not the type of a signal; allowed: SIG_VALTYPE_ id signal : 0; (integer), 1; (single), 2; (double precision)");
    }
    DbcMessage& message = declared(id);
    const auto signal = std::find_if(message.signals.begin(), message.signals.end(),
                                     [&](const DbcSignal& known) { return known.name == name; });
    if (signal == message.signals.end()) {
      refuse(fmt::format("{} has no signal {}", message.name, name));
    }
    if (type == '0') {
      return;
    }
    const bool is_single = type == '1';
    if (signal->length != (is_single ? 32U : 64U)) {
      refuse(fmt::format("{}: {} bits; allowed: 32 for single, 64 for double precision", signal->name, signal->length));
    }
    signal->number = is_single ? DbcNumber::single_precision : DbcNumber::double_precision;
  }

  void read_multiplexing(DbcLine& line) {
    line.blanks();
    const std::string id = line.digits(10);
    line.gap();
    line.word();
    line.gap();
    line.word();
    line.gap();
    const bool has_ranges = !line.up_to(';').empty();
    if (!line.whole() || !has_ranges) {
      refuse("not multiplexing; allowed: SG_MUL_VAL_ id signal multiplexer ranges;");
    }
    declared(id).has_extended_multiplexing = true;
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
    refuse(fmt::format("\"{}\" is not a number", text));
  }

  std::string_view text_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::size_t text_from_ = 0;  ///< line on which a text begins that has not ended, 0: none
  Dbc dbc_;
};

}  // namespace

Dbc read_dbc(std::string_view text, const std::filesystem::path& path) { return DbcReader(text, path).read(); }

Dbc load_dbc(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("{}: cannot be opened; allowed: a DBC file", path.string()));
  }
  std::string text(kLargestDbcFile + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return read_dbc(text, path);
}

}  // namespace hotfire
