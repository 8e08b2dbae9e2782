#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/loop.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::firmware {

/// `plant` answers a bus until asked to stop. `timing` runs a number of cycles to judge the machine.
enum class Mode : std::uint8_t { plant, timing };

struct Options {
  Mode mode = Mode::plant;
  std::string image;  ///< path of a plant image; empty: the reference plant with every effect (timing only)
  LoopSettings loop;
  int priority = 80;       ///< SCHED_FIFO; 0: an ordinary process on purpose
  std::optional<int> cpu;  ///< none: wherever the kernel puts it
  bool require_realtime = false;
  std::optional<double> max_latency_us;
  std::optional<std::uint64_t> max_overruns;
  hal::sim::CommandSource source;
  bool json = false;
  std::string command_line;
};

/// Options, or a text to print and a status to exit with: help and version (0), wrong use (2).
struct ParsedOptions {
  std::optional<Options> options;
  int status = 0;
  std::string message;
};

/// Reads the arguments of hotfire-rt, the program's name first.
ParsedOptions parse_options(const std::vector<std::string>& arguments);

}  // namespace hotfire::firmware
