#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/loop.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::firmware {

/// `plant` answers a bus until asked to stop. `timing` runs a number of cycles to judge the machine. `replay` feeds the
/// commands of a recording to its model, offline.
enum class Mode : std::uint8_t { plant, timing, replay };

/// What gives a plant its cycles: the machine's clock, or syncs on the clock that stand in for those of a rig.
enum class PaceKind : std::uint8_t { clock, sim };
inline constexpr std::array<std::string_view, 2> kPaceKinds{"clock", "sim"};

struct Options {
  Mode mode = Mode::plant;
  std::string image;  ///< path of a plant image; empty: the reference plant with every effect (timing only)
  std::size_t actuators = 1;
  LoopSettings loop;
  PaceKind pace = PaceKind::clock;
  std::uint64_t most_missed_syncs = 10;  ///< in a row
  int priority = 80;                     ///< SCHED_FIFO; 0: an ordinary process on purpose
  std::optional<int> cpu;                ///< none: wherever the kernel puts it
  bool require_realtime = false;
  std::optional<double> max_latency_us;
  std::optional<double> max_step_us;
  std::optional<std::uint64_t> max_overruns;
  hal::sim::CommandSource source;
  std::string recording;  ///< path to write to, or to replay; empty: none
  double record_buffer_s = 8.0;
  std::uint64_t record_max_mib = 16384;
  std::uint64_t max_dropped = 0;  ///< cycles that may be missing in the recording
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
