// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hotfire::hal {

/// A word of a memory that a real-time program fills and others read.
using LiveWord = std::atomic<std::uint64_t>;
static_assert(LiveWord::is_always_lock_free && sizeof(LiveWord) == sizeof(std::uint64_t));

/// The layout of the memory of a live view (docs/interfaces/watch.md): a head, a description as text, then a ring of slots.
/// Each slot begins with its mark: 2 n + 1 while the n-th cycle is written into it, 2 n + 2 afterwards.
struct LiveShape {
  static constexpr std::uint64_t kMagic = 0x31304556494c4648;  ///< the bytes "HFLIVE01"
  /// Words of the head. Those that the program changes have a cache line of their own.
  enum Head : std::size_t { kMagicAt = 0, kTextBytesAt = 1, kSlotWordsAt = 2, kSlotsAt = 3, kPublishedAt = 8, kEndedAt = 9 };
  static constexpr std::size_t kHeadWords = 16;
  /// No larger memory is looked at.
  static constexpr std::size_t kMostTextBytes = std::size_t{1} << 20;
  static constexpr std::size_t kMostSlotWords = 1024;
  static constexpr std::size_t kMostSlots = std::size_t{1} << 16;

  std::size_t text_bytes = 0;
  std::size_t slot_words = 0;  ///< without the mark
  std::size_t slots = 0;

  constexpr std::size_t text_words() const noexcept { return (text_bytes + sizeof(LiveWord) - 1) / sizeof(LiveWord); }
  constexpr std::size_t first_slot() const noexcept { return kHeadWords + text_words(); }
  constexpr std::size_t words() const noexcept { return first_slot() + slots * (slot_words + 1); }
  constexpr bool is_possible() const noexcept {
    return text_bytes <= kMostTextBytes && slot_words > 0 && slot_words <= kMostSlotWords && slots > 1 &&
           slots <= kMostSlots;
  }
};

/// The side of the real-time program. Every call is a bounded number of stores. It reads nothing that another program could
/// have written, so no program can make it wait.
class LiveWriter {
 public:
  LiveWriter() noexcept = default;
  /// `memory`: zeroed, of `shape.words()` words.
  LiveWriter(std::span<LiveWord> memory, const LiveShape& shape) noexcept : memory_(memory), shape_(shape) {}

  /// Opens the next slot. Each word after it is stored with release order: a reader that has read one of them also sees the
  /// mark of an open slot.
  void begin() noexcept {
    slot_ =
        memory_.subspan(shape_.first_slot() + published_ % shape_.slots * (shape_.slot_words + 1), shape_.slot_words + 1);
    slot_[0].store(2 * published_ + 1, std::memory_order_relaxed);
    put_ = 1;
  }

  /// Words that have no room in the slot are left out.
  void put(std::uint64_t word) noexcept {
    if (put_ < slot_.size()) {
      slot_[put_++].store(word, std::memory_order_release);
    }
  }
  void put(std::span<const double> values) noexcept {
    for (const double value : values) {
      put(std::bit_cast<std::uint64_t>(value));
    }
  }

  void publish() noexcept {
    slot_[0].store(2 * published_ + 2, std::memory_order_release);
    ++published_;
    memory_[LiveShape::kPublishedAt].store(published_, std::memory_order_release);
  }

  /// The last words: `why` is not 0.
  void end(std::uint64_t why) noexcept { memory_[LiveShape::kEndedAt].store(why, std::memory_order_release); }

 private:
  std::span<LiveWord> memory_;
  LiveShape shape_;
  std::span<LiveWord> slot_;
  std::size_t put_ = 0;
  std::uint64_t published_ = 0;
};

/// The side of a reader. It only reads, at its own pace: a slot that was overwritten meanwhile is refused.
class LiveReader {
 public:
  LiveReader() noexcept = default;
  LiveReader(std::span<const LiveWord> memory, const LiveShape& shape) noexcept : memory_(memory), shape_(shape) {}

  /// Cycles that have been published since the program started.
  std::uint64_t published() const noexcept { return memory_[LiveShape::kPublishedAt].load(std::memory_order_acquire); }
  /// The reason why the program has ended; 0: it has reported none.
  std::uint64_t ended() const noexcept { return memory_[LiveShape::kEndedAt].load(std::memory_order_acquire); }
  /// The oldest cycle that can still be in the ring.
  std::uint64_t oldest() const noexcept {
    const std::uint64_t count = published();
    return count > shape_.slots ? count - shape_.slots : 0;
  }

  /// Copies the n-th cycle, counted from 0. False if it does not exist yet, does not exist any more, or was overwritten
  /// during the copy. `words` must not be used then.
  bool read(std::uint64_t n, std::span<std::uint64_t> words) const noexcept {
    const std::span<const LiveWord> slot =
        memory_.subspan(shape_.first_slot() + n % shape_.slots * (shape_.slot_words + 1), shape_.slot_words + 1);
    const std::uint64_t whole = 2 * n + 2;
    if (slot[0].load(std::memory_order_acquire) != whole) {
      return false;
    }
    const std::size_t count = std::min(words.size(), shape_.slot_words);
    for (std::size_t i = 0; i < count; ++i) {
      words[i] = slot[i + 1].load(std::memory_order_acquire);
    }
    return slot[0].load(std::memory_order_relaxed) == whole;
  }

 private:
  std::span<const LiveWord> memory_;
  LiveShape shape_;
};

}  // namespace hotfire::hal
