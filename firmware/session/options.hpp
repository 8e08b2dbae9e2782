// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "firmware/can/layout.hpp"
#include "firmware/loop/loop.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::firmware {

/// The trigger of a plant's cycles: the machine's clock, simulated syncs of a rig, or SYNC frames.
enum class PaceKind : std::uint8_t { clock, sim, can };
inline constexpr std::array<std::string_view, 3> kPaceKinds{"clock", "sim", "can"};

/// Scheduling of a loop by the kernel: first-in first-out at a priority, or by the deadline of each cycle.
enum class Scheduler : std::uint8_t { fifo, deadline };
inline constexpr std::array<std::string_view, 2> kSchedulers{"fifo", "deadline"};

/// Of every run of cycles in real time.
struct RunOptions {
  LoopSettings loop;
  std::size_t actuators = 1;
  int priority = 80;  ///< SCHED_FIFO; 0: an ordinary process on purpose
  Scheduler scheduler = Scheduler::fifo;
  std::optional<int> cpu;  ///< none: wherever the kernel puts it
  bool require_realtime = false;
  std::optional<double> max_latency_us;
  std::optional<double> max_step_us;
  std::optional<std::uint64_t> max_overruns;
  std::string live_view;  ///< path of the memory in which the run is shown; empty: none
  bool json = false;
  std::string command_line;
};

/// Of a run with a number of actuators and with commands that the program generates.
struct CommandedRunOptions : RunOptions {
  bool actuators_given = false;  ///< else a vehicle says how many there are
  hal::sim::CommandSource source;
};

/// Of a run of an image, and of its recording, which contains the image.
struct ImageOptions {
  std::string image;  ///< path of a plant image or of a lab's; empty: the reference plant with every effect (timing only)
  std::string recording;   ///< path to write to; empty: none
  bool overwrite = false;  ///< an older file of the recording's name is replaced
  double record_buffer_s = 8.0;
  std::uint64_t record_max_mib = 16384;
  std::uint64_t max_dropped = 0;  ///< cycles that may be missing in the recording
};

/// Of a run that may have a CAN bus.
struct CanOptions {
  std::string bus = "sim";  ///< no bus; or a CAN interface
  std::optional<can::Layout> layout;
  std::string key;  ///< path of the key of commands and readings; empty: they are not authenticated
  double freshness_ms = 1000.0;
  double bit_rate = 0.0;  ///< [bit/s]; 0: what the interface says
  double data_bit_rate = 0.0;
  std::optional<std::uint64_t> max_lost;

  bool on_can() const { return bus != "sim"; }
};

/// Of a run on a CAN bus that gives currents a scale; that of a lab is in its profile.
struct CurrentOptions : CanOptions {
  double command_per_current = 10.0;  ///< [rad/A]
};

/// Of a plant, with a wire or without.
struct PlantRunOptions : CommandedRunOptions, ImageOptions {
  PaceKind pace = PaceKind::clock;
  std::uint64_t most_missed_syncs = 10;    ///< in a row
  std::optional<double> sync_patience_ms;  ///< none: half a period
};

/// Of a plant that answers a bus until it is asked to stop.
struct PlantOptions : PlantRunOptions, CurrentOptions {
  static constexpr std::string_view mode = "plant";
  double command_age_ms = 100.0;
  double heartbeat_age_ms = 50.0;
  bool heartbeat_optional = false;
  bool strings = false;        ///< on a CAN bus: string potentiometers too
  bool load_pressure = false;  ///< on a CAN bus: it sends them
};

/// Of a number of cycles that judge the machine.
struct TimingOptions : PlantRunOptions {
  static constexpr std::string_view mode = "timing";
  TimingOptions() {
    loop.cycles = 10'000;
    max_overruns = 0;
  }
};

/// Of a controller that commands a plant on a CAN bus.
struct ControllerOptions : CommandedRunOptions, CurrentOptions {
  static constexpr std::string_view mode = "controller";
  bool lockstep = false;  ///< no cycle before the plant has answered the last one
};

/// Of a lab, which drives real actuators through a profile.
struct LabOptions : RunOptions, ImageOptions, CanOptions {
  static constexpr std::string_view mode = "lab";
  /// Commands that were not sent in time are not sent at all.
  LabOptions() { loop.policy = OverrunPolicy::skip; }

  std::string gpio;        ///< chip: path, name or label
  std::string confirm;     ///< the digest of the profile, as a person has read it
  bool rehearsal = false;  ///< on a virtual bus, without what a lab on a real one has to have
};

/// Of a replay, which feeds the commands of a recording to its model, offline.
struct ReplayOptions {
  static constexpr std::string_view mode = "replay";
  std::string recording;
  bool json = false;
};

/// Those of one mode, which the first argument names.
using Options = std::variant<PlantOptions, TimingOptions, ControllerOptions, LabOptions, ReplayOptions>;

/// The layout of the frames of a run: the smallest that has room for its actuators, unless one is given.
inline can::Layout frame_layout(const CanOptions& options, std::size_t actuators) {
  return options.layout.value_or(can::smallest_layout(actuators));
}
template <class Own>
can::Layout frame_layout(const Own& options) {
  return frame_layout(options, options.actuators);
}

/// Options, or a text to print and a status to exit with: help and version (0), wrong use (2).
struct ParsedOptions {
  std::optional<Options> options;
  int status = 0;
  std::string message;
};

/// Reads the arguments of hotfire-rt, the program's name first.
ParsedOptions parse_options(const std::vector<std::string>& arguments);

}  // namespace hotfire::firmware
