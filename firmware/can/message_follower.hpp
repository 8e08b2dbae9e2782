// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/can/authentication.hpp"
#include "firmware/can/codec.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// Counts of the frames of one message.
struct MessageCounters {
  std::uint64_t taken = 0;
  std::uint64_t superseded = 0;   ///< good, but a newer one was there before they were looked at
  std::uint64_t repeated = 0;     ///< with the counter of the one before, not taken
  std::uint64_t backward = 0;     ///< with a counter of the past, not taken
  std::uint64_t skipped = 0;      ///< counters that never came: lost on the way
  std::uint64_t refused = 0;      ///< wrong length, check or value, not taken
  std::uint64_t too_many = 0;     ///< beyond what a single sender sends in the time (FrameBudget)
  std::uint64_t unauthentic = 0;  ///< without the key, or replayed, not taken

  /// Damaged on the way, or lost there.
  std::uint64_t damaged() const noexcept { return refused + skipped; }
  /// Frames that a single sender does not send.
  std::uint64_t of_two_senders() const noexcept { return repeated + backward + too_many; }
};

/// Follows every frame of one message. A frame is accepted if it is good and its counter is ahead of the last one by less
/// than half of 256. A frame that is repeated, or comes late from the queue of a gateway, is not accepted.
class MessageFollower {
 public:
  /// From now on accepts only authentic frames, if the message can be authenticated.
  void require(Authentication* authentication) noexcept { authentication_ = authentication; }

  /// The values of a frame. Returns false and leaves `values` unchanged if the frame is not accepted.
  bool take(const Message& message, const hal::CanFrame& frame, std::span<double> values) noexcept {
    std::array<double, kMostSignals> read{};
    std::uint8_t counter = 0;
    if (decode(message, frame, read, counter) != Decoding::good) {
      ++counters_.refused;
      return false;
    }
    if (authentication_ != nullptr && message.can_be_authenticated &&
        !authentication_->accepts(message, frame, newest_us_)) {
      ++counters_.unauthentic;
      return false;
    }
    if (!is_new(counter)) {
      return false;
    }
    std::copy_n(read.begin(), message.signals.size(), values.begin());
    ++counters_.taken;
    return true;
  }

  /// Checks every frame of a subscription; the values are those of the newest accepted one. Returns its time of arrival, or
  /// nothing and unchanged `values` if there is none.
  std::optional<std::int64_t> take_newest(const Message& message, std::span<const hal::CanArrival> arrivals,
                                          std::size_t subscription, std::span<double> values) noexcept {
    std::optional<std::int64_t> arrived_ns;
    for (const hal::CanArrival& arrival : arrivals) {
      if (arrival.subscription == subscription && take(message, arrival.frame, values)) {
        if (arrived_ns) {
          --counters_.taken;
          ++counters_.superseded;
        }
        arrived_ns = arrival.arrived_ns;
      }
    }
    return arrived_ns;
  }

  /// Counts surplus frames, which a single sender does not send.
  void note_too_many(std::uint64_t frames) noexcept { counters_.too_many += frames; }

  /// The counter of the last accepted frame, continued beyond 256.
  std::uint64_t sequence() const noexcept { return sequence_; }
  const MessageCounters& counters() const noexcept { return counters_; }

  /// The next frame is the first again, whatever its counter.
  void forget() noexcept { following_ = false; }

 private:
  static constexpr std::size_t kMostSignals = 32;

  bool is_new(std::uint8_t counter) noexcept {
    constexpr unsigned kHalf = 128;
    if (!following_) {
      following_ = true;
      sequence_ = counter;
      return true;
    }
    const auto ahead = static_cast<std::uint8_t>(counter - static_cast<std::uint8_t>(sequence_));
    if (ahead == 0 || ahead >= kHalf) {
      ++(ahead == 0 ? counters_.repeated : counters_.backward);
      return false;
    }
    counters_.skipped += ahead - 1U;
    sequence_ += ahead;
    return true;
  }

  Authentication* authentication_ = nullptr;
  std::uint64_t newest_us_ = 0;  ///< freshness of the newest frame
  bool following_ = false;
  std::uint64_t sequence_ = 0;
  MessageCounters counters_;
};

}  // namespace hotfire::firmware::can
