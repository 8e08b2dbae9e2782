#pragma once

#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/loop.hpp"
#include "firmware/options.hpp"
#include "firmware/recorder.hpp"
#include "hal/realtime.hpp"

namespace hotfire::firmware {

/// All that is known when a loop has ended.
struct Session {
  const Options& options;
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
  hal::CpuPlace place{};
  std::time_t started = 0;
  std::time_t ended = 0;
};

/// Whether the limits that were asked for are met, and the sentence that says so.
struct Verdict {
  bool good = true;
  std::string reason;
};
Verdict judge(const Session& session);

/// The result as text with a picture of the wake-up latency, or as JSON shaped as cyclictest's with `hotfire` added.
std::string text_report(const Session& session);
std::string json_report(const Session& session);

/// Sets up, runs the loop, prints the report to standard output and what the machine refused to standard error. Returns the
/// exit status.
int run_session(const Options& options);

}  // namespace hotfire::firmware
