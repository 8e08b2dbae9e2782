// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/can/message_follower.hpp"
#include "firmware/interlock/faults.hpp"
#include "firmware/live/live_view.hpp"
#include "firmware/loop/loop.hpp"
#include "firmware/session/recording_session.hpp"
#include "hal/can.hpp"
#include "hal/linux/live_file.hpp"

namespace hotfire::firmware {

/// Counters of a run for its live view, each read at its source. The sources must outlive the view.
class LiveCounters {
 public:
  LiveCounters& loop(const LoopResult& result);
  LiveCounters& recorder(const Recorder& recorder);
  /// `bus`: whose `counters` and `state` are those of a CanBus.
  template <class Bus>
  LiveCounters& can(const Bus& bus) {
    return can_state([&bus] { return static_cast<std::uint64_t>(bus.state()); }).can_frames(bus.counters());
  }
  LiveCounters& message(const std::string& name, const can::MessageCounters& counters);
  /// How often each fault was the first: `times_first(fault)`.
  template <class TimesFirst>
  LiveCounters& faults(TimesFirst times_first) {
    for (const FaultText& text : kFaults) {
      add("faults", std::to_string(static_cast<int>(text.fault)),
          [times_first, fault = text.fault] { return static_cast<std::uint64_t>(times_first(fault)); });
    }
    return *this;
  }
  LiveCounters& add(const std::string& group, const std::string& name, std::function<std::uint64_t()> value);

  const std::vector<LiveCounter>& all() const noexcept { return counters_; }

 private:
  LiveCounters& can_state(std::function<std::uint64_t()> value);
  LiveCounters& can_frames(const hal::CanCounters& counters);

  std::vector<LiveCounter> counters_;
};

/// The live view of a run, in memory that other programs read, if the options name a file for it.
class LiveSession {
 public:
  explicit LiveSession(const RunOptions& options) : options_(options), file_(options.live_view) {}

  /// Makes the file with these counters and those of the loop and the recorder, and connects the outputs to it. Call it
  /// before the real-time set-up of the calling thread. All references must outlive the loop.
  std::optional<hal::Failure> start(const RecordedPlant& plant, LiveCounters counters, const LoopResult& result,
                                    CycleOutputs& outputs);

  void close(Ending ending) noexcept;

 private:
  const RunOptions& options_;
  hal::LiveFile file_;
  std::optional<LiveView> view_;
};

}  // namespace hotfire::firmware
