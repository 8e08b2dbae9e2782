// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "tools/files/can/candump.hpp"

namespace hotfire {

/// Gives a command the options that say how a candump log is understood.
inline void add_candump_options(CLI::App& command, CandumpOptions& options) {
  constexpr unsigned kMostActuators = 8;
  command.add_option("--actuator", options.actuator, "actuator to read from a candump log (.log)")
      ->check(CLI::Range(1U, kMostActuators))
      ->capture_default_str();
  command.add_option("--command-per-current", options.command_per_current,
                     "command that a servovalve current in a candump log represents [rad/A]");
}

}  // namespace hotfire
