// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "firmware/session/options.hpp"

namespace hotfire::firmware {

/// One option of hotfire-rt: its text in the help, the modes that take it, and its reader.
struct OptionLine {
  std::string_view name;
  std::string_view value;  ///< empty: a flag
  std::string_view meaning;
  /// Reads a value into the options of a mode that takes it; returns what is allowed if it is not.
  std::string (*read)(const std::string& value, Options& options);
  std::array<bool, std::variant_size_v<Options>> modes;  ///< which take it, in the order of `Options`
};

/// Every option, in the order of the help.
std::span<const OptionLine> option_lines();

/// "plant, timing": the modes that take an option.
std::string modes_of(const OptionLine& line);

/// The text of `hotfire-rt MODE --help`: the options of that mode. For a word that is no mode: the options of every mode
/// with the names of the modes. `hotfire MODE --help` prints the same, so the text also has the options of `hotfire`.
std::string help_of(std::string_view mode);

}  // namespace hotfire::firmware
