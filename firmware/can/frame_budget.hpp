// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace hotfire::firmware::can {

/// The number of frames of a message that one sender may have sent: one every `due_ns`. It detects a second sender whose
/// counters fit those of the first. It is a leaky bucket in time (ITU-T I.371, generic cell rate algorithm) with two depths:
///
/// - A frame may come early by less than two frames. This covers the phases of two clocks and their jitter. If every frame
///   comes on time, a second sender is detected in the second cycle in which both have sent.
/// - Frames that did not come when they were due may come later and together, as from the queue of a gateway. These are the
///   frames of `held_up_ns`, because an older reading is a fault by itself, and at most kMostHeldUp.
class FrameBudget {
 public:
  FrameBudget() noexcept = default;
  FrameBudget(std::int64_t due_ns, std::int64_t held_up_ns) noexcept
      : due_ns_(due_ns),
        early_ns_(due_ns + due_ns / 2),
        most_ns_(early_ns_ + std::clamp(held_up_ns, due_ns, kMostHeldUp * due_ns)) {}

  /// Called in every cycle with the number of its frames. Returns the number of surplus frames, which a single sender does
  /// not send.
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
  /// Frames that a node or a gateway may delay and then send together.
  static constexpr std::int64_t kMostHeldUp = 16;
  /// A node's clock may be fast by one part in this number: a hundred times the drift of a quartz.
  static constexpr std::int64_t kClockTolerance = 100;

  static constexpr std::int64_t kNotBegun = -1;

  std::int64_t due_ns_ = 1;
  std::int64_t early_ns_ = 1;
  std::int64_t most_ns_ = 1;
  std::int64_t saved_ns_ = kNotBegun;
  std::int64_t before_ns_ = 0;
};

}  // namespace hotfire::firmware::can
