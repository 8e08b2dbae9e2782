// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/can/message.hpp"

namespace hotfire::firmware::can {

/// How many frames of a message one sender may have sent: one for every time that it is due, which is every cycle or as
/// often as the map says, whichever is more often. Two senders whose counters happen to fit are found by this. A leaky
/// bucket in time (ITU-T I.371, generic cell rate algorithm).
class FrameBudget {
 public:
  FrameBudget() noexcept = default;
  FrameBudget(const Message& message, std::int64_t period_ns) noexcept
      : due_ns_(std::min(period_ns, message.cycle_ms * kMillisecond)) {}

  /// In every cycle, with the frames that it has brought. Returns how many of them are more than one sender sends.
  std::uint64_t excess(std::uint64_t frames, std::int64_t now_ns) noexcept {
    if (!begun_) {
      // What had gathered before the first cycle says nothing about a rate.
      begun_ = true;
      saved_ns_ = kMostHeldUp * due_ns_;
      before_ns_ = now_ns;
      return 0;
    }
    // A loop that catches up has cycles that take no time, and a node that answers SYNC answers each of them.
    saved_ns_ = std::min(saved_ns_, kMostHeldUp * due_ns_) + std::max(now_ns - before_ns_, due_ns_);
    before_ns_ = now_ns;
    const std::int64_t cost_ns = due_ns_ - due_ns_ / kClockTolerance;
    const auto allowed = static_cast<std::uint64_t>(saved_ns_ / cost_ns);
    const std::uint64_t taken = std::min(frames, allowed);
    saved_ns_ -= static_cast<std::int64_t>(taken) * cost_ns;
    return frames - taken;
  }

  void forget() noexcept { begun_ = false; }

 private:
  static constexpr std::int64_t kMillisecond = 1'000'000;
  /// Frames that a node or a gateway may hold up and then send at once. Longer than this is a stale reading anyway.
  static constexpr std::int64_t kMostHeldUp = 16;
  /// A node's clock may be fast by one part in this: a hundred times what a quartz drifts.
  static constexpr std::int64_t kClockTolerance = 100;

  std::int64_t due_ns_ = kMillisecond;
  std::int64_t saved_ns_ = 0;
  std::int64_t before_ns_ = 0;
  bool begun_ = false;
};

}  // namespace hotfire::firmware::can
