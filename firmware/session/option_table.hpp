// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "firmware/session/options.hpp"

namespace hotfire::firmware {

/// One option of hotfire-rt: what the help says, which modes take it, and how it is read.
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

/// What `hotfire-rt MODE --help` prints: the options of that mode alone; of every mode, and with their names, for a word
/// that is no mode. `hotfire MODE --help` prints the same, so that the options of `hotfire` are in it.
std::string help_of(std::string_view mode);

}  // namespace hotfire::firmware
