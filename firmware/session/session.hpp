// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/can/bus_account.hpp"
#include "firmware/interlock/interlock.hpp"
#include "firmware/loop/loop.hpp"
#include "firmware/recording/recorder.hpp"
#include "firmware/service/status.hpp"
#include "firmware/session/options.hpp"
#include "hal/realtime.hpp"

namespace hotfire::firmware {

/// The result of a lab's profile.
struct LabAccount {
  RigState state = RigState::safe;  ///< when the loop ended
  bool completed = false;           ///< the profile was run to its end
  std::uint64_t armings = 0;
  FaultCounts times_first{};  ///< how often each was the first that made the rig faulted
  Fault first = Fault{};      ///< of those since the last arming; 0: none
  bool left_the_bus = true;   ///< no command is before the bus
  bool lines_dropped = true;  ///< every output was set to off at the end
  bool came_to_rest = true;   ///< false if the time to stop was over before every piston was at rest
};

/// All that is known when a loop has ended.
struct Session {
  const RunOptions& options;
  const LoopResult& result;
  std::string_view topology;
  std::span<const std::string_view> channels;
  std::span<const std::string_view> channel_units;
  int steps_per_cycle = 1;
  bool real_time = false;                      ///< memory locked and first-in first-out scheduling
  std::vector<hal::Failure> failures{};        ///< what of the real-time set-up the machine refused
  hal::ResourceUsage usage{};                  ///< of the loop after warm-up
  std::optional<std::uint64_t> allocations{};  ///< of the loop after warm-up, if a guard is linked
  const RecorderAccount* recording = nullptr;  ///< null: nothing was recorded
  std::string_view recording_file{};           ///< its path
  std::uint64_t max_dropped = 0;               ///< cycles that may be missing in it
  std::optional<BusAccount> bus{};             ///< none: there is no wire
  std::optional<std::uint64_t> max_lost{};     ///< frames that may be lost; none: no limit
  bool synchronised = false;                   ///< syncs give the cycles, not the machine's clock
  std::optional<LabAccount> lab{};
  std::string_view input = "commands";  ///< what the loop takes in every cycle, and what it sends
  std::string_view output = "readings";
  bool is_vehicle = false;  ///< one plant of all actuators, not a copy for each
  hal::CpuPlace place{};
  std::time_t started = 0;
  std::time_t ended = 0;
};

/// Whether the requested limits are met, the sentence that reports it, and the exit status.
struct Verdict {
  bool good = true;
  std::string reason{};
  Status status = kGood;
};
Verdict judge(const Session& session);

/// The result as text with a picture of the wake-up latency, or as JSON shaped as cyclictest's with `hotfire` added.
std::string text_report(const Session& session);
std::string json_report(const Session& session);

/// Each of these sets up, runs its loop and prints the report to standard output. Refusals of the machine go to standard
/// error. The result is the exit status.
int run(const PlantOptions& options);
int run(const TimingOptions& options);
int run(const ControllerOptions& options);
int run(const LabOptions& options);

}  // namespace hotfire::firmware
