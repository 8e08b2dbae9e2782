// SPDX-License-Identifier: Apache-2.0
// Writes what firmware/ knows of the CAN map, from the DBC file: generate MAP.dbc can_map.hpp

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "tools/files/can/can_crc.hpp"
#include "tools/files/can/can_map.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

/// SERVOVALVE_COMMAND: servovalve_command
std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

std::string crc_table(const CanCrc& crc, const std::string& type, const std::string& name) {
  std::string text = fmt::format("inline constexpr std::array<{}, 256> {}{{{{", type, name);
  for (unsigned byte = 0; byte < 256; ++byte) {
    text += fmt::format("{}{:#x},", byte % 16 == 0 ? "\n    " : " ", crc.add(0, static_cast<std::uint8_t>(byte)));
  }
  return text + "}};\n" +
         fmt::format("inline constexpr {0} {1}Start = {2:#x};\ninline constexpr {0} {1}FinalXor = {3:#x};\n\n", type, name,
                     crc.start, crc.final_xor);
}

std::string message_text(const CanMessage& message) {
  constexpr std::size_t kProtection = 2;      // check and counter
  constexpr std::size_t kAuthentication = 3;  // freshness and both halves of the code
  const std::size_t end = message.signals.size() - (message.has_authentication() ? kAuthentication : 0);
  std::string names;
  std::string rows;
  for (std::size_t i = kProtection; i < end; ++i) {
    const CanSignal& signal = message.signals[i];
    names += fmt::format("inline constexpr std::size_t {} = {};  ///< [{}]\n", signal.name, i - kProtection,
                         signal.unit.empty() ? "1" : signal.unit);
    rows += fmt::format("    {{\"{}\", {}, {}, {}, {:.17g}, {:.17g}, {}, {}}},\n", signal.name, signal.start, signal.length,
                        signal.is_signed, signal.factor, signal.offset, signal.lowest_raw, signal.highest_raw);
  }
  return fmt::format(
      "namespace {} {{\n{}inline constexpr std::array<Signal, {}> kSignals{{{{\n{}}}}};\n"
      "inline constexpr Message kMessage{{\"{}\", {:#x}, {:#x}, {}, {}, {}, {}, {}, kSignals}};\n}}\n\n",
      lower(message.name), names, end - kProtection, rows, message.name, message.id, message.data_id, message.fd,
      message.has_authentication(), message.length, message.crc_bits(), message.cycle_ms);
}

std::string header(const CanMap& map) {
  std::string text =
      "// Made from firmware/can/hotfire.dbc by tools/can/generate.cpp.\n#pragma once\n\n#include <array>\n#include "
      "<cstddef>\n#include <cstdint>\n\n#include \"firmware/can/message.hpp\"\n\nnamespace hotfire::firmware::can {\n\n" +
      crc_table(kCanCrc8, "std::uint8_t", "kCrc8") + crc_table(kCanCrc16, "std::uint16_t", "kCrc16");
  std::string all;
  for (const CanMessage& message : map.messages) {
    text += message_text(message);
    all += fmt::format("    &{}::kMessage,\n", lower(message.name));
  }
  return text +
         fmt::format(
             "/// Every message of the map.\ninline constexpr std::array<const Message*, {}> kMessages{{{{\n{}}}}};\n\n}}\n",
             map.messages.size(), all);
}

}  // namespace

}  // namespace hotfire

int main(int count, char** values) {
  if (count != 3) {
    std::cerr << "usage: generate MAP.dbc can_map.hpp\n";
    return static_cast<int>(hotfire::ExitStatus::wrong_use);
  }
  try {
    std::ifstream file(values[1], std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    hotfire::write_whole_file(values[2], hotfire::header(hotfire::read_can_map(text, values[1])));
  } catch (const hotfire::FileError& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(hotfire::ExitStatus::bad_data);
  }
  return 0;
}
