// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/recording/recorder.hpp"
#include "hal/live/description.hpp"
#include "hal/live/ring.hpp"

namespace hotfire::firmware {

/// A count of the running program. The loop's thread reads it without allocation, lock or system call.
struct LiveCounter {
  std::string group;
  std::string name;
  std::function<std::uint64_t()> value;
};

/// The live view of a running program: every cycle with the counters at its end.
class LiveView {
 public:
  LiveView(hal::LiveWriter writer, std::vector<LiveCounter> counters) noexcept
      : writer_(writer), counters_(std::move(counters)) {}

  /// Real-time, wait-free.
  void record(const hal::CycleHead& head, std::span<const double> commands, std::span<const double> readings) noexcept {
    writer_.begin();
    for (const std::uint64_t word : std::bit_cast<HeadWords>(head)) {
      writer_.put(word);
    }
    writer_.put(commands);
    writer_.put(readings);
    for (const LiveCounter& counter : counters_) {
      writer_.put(counter.value());
    }
    writer_.publish();
  }

  /// The program has ended. Not 0.
  void end(std::uint64_t why) noexcept { writer_.end(why); }

 private:
  using HeadWords = std::array<std::uint64_t, sizeof(hal::CycleHead) / sizeof(std::uint64_t)>;

  hal::LiveWriter writer_;
  std::vector<LiveCounter> counters_;
};

/// The outputs of a loop's cycles: a recorder, a live view, both or none.
struct CycleOutputs {
  Recorder* recorder = nullptr;
  LiveView* view = nullptr;

  void record(const hal::CycleHead& head, std::span<const double> commands, std::span<const double> readings) noexcept {
    if (recorder != nullptr) {
      recorder->record(head, commands, readings);
    }
    if (view != nullptr) {
      view->record(head, commands, readings);
    }
  }
};

}  // namespace hotfire::firmware
