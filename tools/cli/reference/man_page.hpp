// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/cli/reference/realtime_help.hpp"

namespace hotfire {

/// hotfire(1): the list of commands, from the descriptions that `hotfire --help` prints.
std::string program_page(const CLI::App& program);

/// hotfire-COMMAND(1), from the descriptions that `hotfire COMMAND --help` prints. A command that hotfire-rt carries out has
/// the examples of `realtime` that show it, and refers to hotfire-rt(1) for the options.
std::string command_page(const CLI::App& command, const RealtimeHelp& realtime);

/// hotfire-rt(1), from what `hotfire-rt --help` prints.
std::string realtime_page(const RealtimeHelp& realtime);

}  // namespace hotfire
