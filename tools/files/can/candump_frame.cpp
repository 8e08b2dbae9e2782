// SPDX-License-Identifier: Apache-2.0
#include "tools/files/can/candump_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/files/can/dbc.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kForm =
    "allowed: lines of 'candump -l' or 'candump -L', (1436509052.249713) can0 123#1122334455667788";
constexpr std::size_t kBaseDigits = 3;
constexpr std::size_t kExtendedDigits = 8;
constexpr std::uint32_t kLargestFrameId = 0x1FFFFFFF;  ///< candump writes error frames as ids above it

[[noreturn]] void refuse(const CsvLines& lines, std::string_view line) {
  constexpr std::size_t kMost = 60;
  lines.refuse(fmt::format("\"{}\": no frame of a candump log; {}", line.substr(0, kMost), kForm));
}

/// The whole text as a hexadecimal number, or nothing.
template <class Number>
bool read_hex(std::string_view text, Number& number) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  number = static_cast<Number>(value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Takes the words of a line one by one.
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(word.size());
  return word;
}

bool read_data(std::string_view text, CandumpFrame& frame) {
  constexpr std::size_t kMostDigits = 2 * 64;
  if (text.size() % 2 != 0 || text.size() > kMostDigits) {
    return false;
  }
  for (std::size_t i = 0; i < text.size(); i += 2) {
    if (!read_hex(text.substr(i, 2), frame.data.emplace_back())) {
      return false;
    }
  }
  return true;
}

CandumpFrame frame_of(const CsvLines& lines, std::string_view line) {
  CandumpFrame frame;
  std::string_view rest = line;
  const std::string_view stamp = next_word(rest);
  frame.interface = next_word(rest);
  const std::string_view text = next_word(rest);
  const std::size_t mark = text.find('#');
  if (stamp.size() < 3 || stamp.front() != '(' || stamp.back() != ')' || mark == std::string_view::npos) {
    refuse(lines, line);
  }
  const std::string_view seconds = stamp.substr(1, stamp.size() - 2);
  const auto [end, error] = std::from_chars(seconds.data(), seconds.data() + seconds.size(), frame.time);
  if (error != std::errc{} || end != seconds.data() + seconds.size() || !(frame.time >= 0.0) ||
      (mark != kBaseDigits && mark != kExtendedDigits) || !read_hex(text.substr(0, mark), frame.id)) {
    refuse(lines, line);
  }
  std::string_view data = text.substr(mark + 1);
  frame.fd = data.starts_with('#');
  frame.is_data = frame.id <= kLargestFrameId && !data.starts_with('R');
  if (!frame.is_data) {
    return frame;
  }
  frame.id |= mark == kExtendedDigits ? kExtendedId : 0;
  data.remove_prefix(frame.fd ? 1 : 0);
  if (frame.fd) {
    unsigned flags = 0;
    if (!read_hex(data.substr(0, 1), flags)) {
      refuse(lines, line);
    }
    data.remove_prefix(1);
  }
  if (!read_data(data.substr(0, data.find('_')), frame)) {  // behind '_': the length code of a short frame
    refuse(lines, line);
  }
  return frame;
}

}  // namespace

std::optional<CandumpFrame> next_candump_frame(CsvLines& lines) {
  std::string_view line;
  while (lines.next(line)) {
    if (line.find_first_not_of(' ') != std::string_view::npos) {
      return frame_of(lines, line);
    }
  }
  return std::nullopt;
}

std::string candump_line(const CandumpFrame& frame) {
  const bool is_extended = (frame.id & kExtendedId) != 0;
  std::string line = fmt::format("({:.6f}) {} {:0{}X}#{}", frame.time, frame.interface, frame.id & ~kExtendedId,
                                 is_extended ? kExtendedDigits : kBaseDigits, frame.fd ? "#1" : "");
  for (const std::uint8_t byte : frame.data) {
    line += fmt::format("{:02X}", byte);
  }
  return line + '\n';
}

}  // namespace hotfire
