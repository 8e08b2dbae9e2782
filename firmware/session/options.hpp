// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/can/layout.hpp"
#include "firmware/loop/loop.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::firmware {

/// `plant` answers a bus until asked to stop. `timing` runs a number of cycles to judge the machine. `controller` commands a
/// plant on a CAN bus. `lab` drives real actuators through a profile. `replay` feeds the commands of a recording to its
/// model, offline.
enum class Mode : std::uint8_t { plant, timing, controller, lab, replay };

/// What gives a plant its cycles: the machine's clock, syncs on the clock that replace those of a rig, or SYNC frames.
enum class PaceKind : std::uint8_t { clock, sim, can };
inline constexpr std::array<std::string_view, 3> kPaceKinds{"clock", "sim", "can"};

struct Options {
  Mode mode = Mode::plant;
  std::string image;        ///< path of a plant image; empty: the reference plant with every effect (timing only)
  std::string gpio;         ///< chip of a lab: path, name or label
  std::string bus = "sim";  ///< or a CAN interface
  std::optional<can::Layout> layout;
  double command_per_current = 10.0;  ///< [rad/A]
  double command_age_ms = 100.0;
  double heartbeat_age_ms = 50.0;
  std::string key;  ///< path of the key of commands and readings; empty: they are not authenticated
  double freshness_ms = 1000.0;
  double bit_rate = 0.0;  ///< [bit/s]; 0: what the interface says
  double data_bit_rate = 0.0;
  std::optional<std::uint64_t> max_lost;
  std::size_t actuators = 1;
  bool actuators_given = false;  ///< else a vehicle says how many there are
  bool strings = false;          ///< of a plant on a CAN bus: string potentiometers too
  bool load_pressure = false;    ///< of a plant on a CAN bus: it sends them; of a lab: it takes them, as its profile says
  LoopSettings loop;
  PaceKind pace = PaceKind::clock;
  std::uint64_t most_missed_syncs = 10;    ///< in a row
  std::optional<double> sync_patience_ms;  ///< none: half a period
  bool lockstep = false;                   ///< of the controller: no cycle before the plant has answered the last one
  int priority = 80;                       ///< SCHED_FIFO; 0: an ordinary process on purpose
  std::optional<int> cpu;                  ///< none: wherever the kernel puts it
  bool require_realtime = false;
  std::string confirm;     ///< of a lab: the digest of its profile, as a person has read it
  bool rehearsal = false;  ///< of a lab: on a virtual bus, without what a lab on a real one has to have
  std::optional<double> max_latency_us;
  std::optional<double> max_step_us;
  std::optional<std::uint64_t> max_overruns;
  hal::sim::CommandSource source;
  std::string recording;   ///< path to write to, or to replay; empty: none
  bool overwrite = false;  ///< an older file of the recording's name is replaced
  double record_buffer_s = 8.0;
  std::uint64_t record_max_mib = 16384;
  std::uint64_t max_dropped = 0;  ///< cycles that may be missing in the recording
  std::string live_view;          ///< path of the memory in which the run is shown; empty: none
  bool json = false;
  std::string command_line;

  bool on_can() const { return bus != "sim"; }
  can::Layout frame_layout() const { return layout.value_or(can::smallest_layout(actuators)); }
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
