// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hotfire::firmware {

/// A ring of slots of equal size between one thread that fills it and one that empties it. Both sides are wait-free. Each
/// call is a bounded number of instructions, whatever the other side does. It does not allocate and makes no system call.
class RecordingRing {
 public:
  /// Touches all its memory, so that no later use causes a page fault.
  RecordingRing(std::size_t slot_bytes, std::size_t slots)
      : slot_bytes_(slot_bytes), slots_(slots), memory_(slot_bytes * slots) {}

  /// The filling side: the next free slot, to be published; null if there is none.
  std::byte* try_claim() noexcept {
    const std::uint64_t filled = filled_.load(std::memory_order_relaxed);
    if (filled - emptied_seen_ == slots_) {
      emptied_seen_ = emptied_.load(std::memory_order_acquire);
      if (filled - emptied_seen_ == slots_) {
        return nullptr;
      }
    }
    return memory_.data() + filled % slots_ * slot_bytes_;
  }
  /// Slots that are filled and not yet released.
  std::size_t waiting() const noexcept {
    return filled_.load(std::memory_order_relaxed) - emptied_.load(std::memory_order_relaxed);
  }
  void publish() noexcept { filled_.store(filled_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// The emptying side: up to `most` filled slots that lie one after the other, oldest first. They stay until released.
  std::span<const std::byte> filled(std::size_t most) const noexcept {
    const std::uint64_t emptied = emptied_.load(std::memory_order_relaxed);
    const auto waiting = static_cast<std::size_t>(filled_.load(std::memory_order_acquire) - emptied);
    const std::size_t first = emptied % slots_;
    const std::size_t count = std::min({waiting, most, slots_ - first});
    return std::span(memory_).subspan(first * slot_bytes_, count * slot_bytes_);
  }
  void release(std::size_t slots) noexcept {
    emptied_.store(emptied_.load(std::memory_order_relaxed) + slots, std::memory_order_release);
  }

  std::size_t slot_bytes() const noexcept { return slot_bytes_; }
  std::size_t slots() const noexcept { return slots_; }

 private:
  static constexpr std::size_t kCacheLine = 64;
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  std::size_t slot_bytes_;
  std::size_t slots_;
  std::vector<std::byte> memory_;
  alignas(kCacheLine) std::atomic<std::uint64_t> filled_{0};
  std::uint64_t emptied_seen_ = 0;  ///< the filling side's own, so that it seldom touches the other's line
  alignas(kCacheLine) std::atomic<std::uint64_t> emptied_{0};
};

}  // namespace hotfire::firmware
