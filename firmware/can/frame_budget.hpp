// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace hotfire::firmware::can {

/// How many frames of a message one sender may have sent: one every `due_ns`. Two senders whose counters happen to fit are
/// found by this. A leaky bucket in time (ITU-T I.371, generic cell rate algorithm) with two depths:
///
/// - A frame may come early by less than two, which is what the phases of two clocks and their jitter do. Where every frame
///   comes when it is due, a second sender is thus found in the second cycle in which both have sent.
/// - Frames that did not come when they were due may come later and at once, as from the queue of a gateway: those of
///   `held_up_ns`, as a reading that is older is a fault by itself, and kMostHeldUp at most.
class FrameBudget {
 public:
  FrameBudget() noexcept = default;
  FrameBudget(std::int64_t due_ns, std::int64_t held_up_ns) noexcept
      : due_ns_(due_ns),
        early_ns_(due_ns + due_ns / 2),
        most_ns_(early_ns_ + std::clamp(held_up_ns, due_ns, kMostHeldUp * due_ns)) {}

  /// In every cycle, with the frames that it has brought. Returns how many of them are more than one sender sends.
  std::uint64_t excess(std::uint64_t frames, std::int64_t now_ns) noexcept {
    if (saved_ns_ == kNotBegun) {
      // What had gathered before the first cycle says nothing about a rate.
      saved_ns_ = early_ns_;
      before_ns_ = now_ns;
      return 0;
    }
    const std::int64_t passed_ns = now_ns - before_ns_;
    before_ns_ = now_ns;
    saved_ns_ = std::min(saved_ns_, most_ns_) + passed_ns;
    const std::uint64_t taken = std::min(frames, static_cast<std::uint64_t>(saved_ns_ / due_ns_));
    saved_ns_ -= static_cast<std::int64_t>(taken) * due_ns_;
    if (saved_ns_ < early_ns_) {
      saved_ns_ = std::min(early_ns_, saved_ns_ + passed_ns / kClockTolerance);
    }
    return frames - taken;
  }

  void forget() noexcept { saved_ns_ = kNotBegun; }

 private:
  /// Frames that a node or a gateway may hold up and then send at once.
  static constexpr std::int64_t kMostHeldUp = 16;
  /// A node's clock may be fast by one part in this: a hundred times what a quartz drifts.
  static constexpr std::int64_t kClockTolerance = 100;

  static constexpr std::int64_t kNotBegun = -1;

  std::int64_t due_ns_ = 1;
  std::int64_t early_ns_ = 1;
  std::int64_t most_ns_ = 1;
  std::int64_t saved_ns_ = kNotBegun;
  std::int64_t before_ns_ = 0;
};

}  // namespace hotfire::firmware::can
