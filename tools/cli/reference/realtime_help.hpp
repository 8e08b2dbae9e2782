// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire {

/// One line of hotfire-rt's table of options.
struct RealtimeOption {
  std::string name;     ///< with its hyphens
  std::string value;    ///< empty: a flag
  std::string meaning;  ///< in one line
};

/// What `hotfire-rt --help` or `hotfire-rt MODE --help` prints, by its parts. hotfire-rt keeps its table to itself, so that
/// it needs nothing of the host.
struct RealtimeHelp {
  std::string introduction;
  std::string usage;
  std::vector<std::string> examples;
  std::vector<RealtimeOption> options;  ///< also those that `hotfire` alone takes
  std::string ending;                   ///< with the exit statuses
};

/// The parts of such a text.
RealtimeHelp parse_realtime_help(const std::string& text);

/// Asks the hotfire-rt beside this program for the help of a mode, or of all if the mode is empty. Throws UsageError if
/// there is no such program.
RealtimeHelp realtime_help(const std::string& mode);

}  // namespace hotfire
