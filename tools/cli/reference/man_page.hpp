// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/cli/reference/realtime_help.hpp"

namespace hotfire {

/// hotfire(1): the list of commands, from the descriptions that `hotfire --help` prints.
std::string program_page(const CLI::App& program);

/// hotfire-COMMAND(1), from the descriptions that `hotfire COMMAND --help` prints.
std::string command_page(const CLI::App& command);

/// The page of a command that hotfire-rt carries out, from what `hotfire-rt COMMAND --help` prints.
std::string realtime_command_page(const CLI::App& command, const RealtimeHelp& realtime);

/// hotfire-rt(1), from what `hotfire-rt --help` prints.
std::string realtime_page(const RealtimeHelp& realtime);

}  // namespace hotfire
