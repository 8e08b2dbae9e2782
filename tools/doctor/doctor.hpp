// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hotfire::doctor {

/// `good`: as it should be. `advice`: good enough for a bench, not for the shortest latencies, or not to be seen from here.
/// `bad`: a run on this machine does not keep its contract.
enum class Level { good, advice, bad };

/// One thing that was looked at.
struct Finding {
  std::string check;  ///< "governor"
  Level level = Level::good;
  std::string what;    ///< what was found, with the value
  std::string remedy;  ///< the command or line that is the remedy; empty if good
};

/// What is to be looked at, and through which eyes.
struct Patient {
  std::filesystem::path root = "/";  ///< of /sys, /proc and /dev
  std::optional<int> cpu;            ///< the loop's; none: wherever the kernel puts it
  std::vector<std::string> can;      ///< interfaces that must be there; empty: those that are
  std::vector<std::string> lines;    ///< GPIO lines that must be there
  /// Output of a command, empty if it cannot be run.
  std::function<std::string(const std::string& command)> run;
};

/// Kernel, preemption, isolation, hyper-threads, governor, limits, clock source, sleep states.
std::vector<Finding> look_at_machine(const Patient& patient);

/// CAN interfaces: up, bit rate, automatic restart, state, error counters, queue.
std::vector<Finding> look_at_can(const Patient& patient);

/// GPIO chips and the lines that are asked for.
std::vector<Finding> look_at_gpio(const Patient& patient);

/// All of them.
std::vector<Finding> look(const Patient& patient);

/// Runs a command of the shell. Its standard error is dropped.
std::string run_command(const std::string& command);

}  // namespace hotfire::doctor
