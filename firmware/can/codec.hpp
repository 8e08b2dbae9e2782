// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/can/message.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// What a frame is found to be; the first that applies.
enum class Decoding : std::uint8_t { good, wrong_id, wrong_format, wrong_length, wrong_crc, out_of_range };
inline constexpr std::array<std::string_view, 6> kDecodings{"good",         "wrong id",  "wrong format",
                                                            "wrong length", "wrong CRC", "out of range"};

/// Takes a frame apart: the physical values of `message.signals` in their order, and its counter. Both are touched only if
/// the frame is good: of this id, format and length, with the right check, every value within its range. Bits that no
/// signal has may be anything. `values` has room for all signals. Constant time for a message; no allocation.
Decoding decode(const Message& message, const hal::CanFrame& frame, std::span<double> values,
                std::uint8_t& counter) noexcept;

/// Puts a frame together; values are rounded to the nearest code. False, and `frame` untouched, if one is not finite or
/// beyond its range: what cannot be said is not said wrongly. FD frames ask for the faster bit rate.
bool encode(const Message& message, std::span<const double> values, std::uint8_t counter, hal::CanFrame& frame) noexcept;

/// Puts the check of a frame in its place, after its bytes were changed.
void put_check(const Message& message, hal::CanFrame& frame) noexcept;

/// Follows the counter of a message.
class Sequence {
 public:
  /// What a counter says after the one before it: the first ever, the next, the same again, or later by more than one.
  enum class Step : std::uint8_t { first, next, repeated, skipped };

  Step see(std::uint8_t counter) noexcept {
    const auto ahead = static_cast<std::uint8_t>(counter - last_);
    const Step step = !seen_ ? Step::first : ahead == 1 ? Step::next : ahead == 0 ? Step::repeated : Step::skipped;
    lost_ += step == Step::skipped ? ahead - 1U : 0U;
    last_ = counter;
    seen_ = true;
    return step;
  }

  /// Counters that were left out; one that goes back counts as nearly all of 256.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::uint8_t last_ = 0;
  bool seen_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace hotfire::firmware::can
