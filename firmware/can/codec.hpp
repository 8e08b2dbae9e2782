// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/can/message.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// Result of decoding a frame: the first that applies.
enum class Decoding : std::uint8_t { good, wrong_id, wrong_format, wrong_length, wrong_crc, out_of_range };
inline constexpr std::array<std::string_view, 6> kDecodings{"good",         "wrong id",  "wrong format",
                                                            "wrong length", "wrong CRC", "out of range"};

/// Decodes a frame: the physical values of `message.signals` in their order, and its counter. Both change only if the frame
/// is good. It then has this id, format and length, the right check, and every value in its range. Bits without a signal are
/// ignored. `values` has room for all signals. Constant time for a message; no allocation.
Decoding decode(const Message& message, const hal::CanFrame& frame, std::span<double> values,
                std::uint8_t& counter) noexcept;

/// Encodes a frame; values are rounded to the nearest code. Returns false and leaves `frame` unchanged if a value is not
/// finite or beyond its range. FD frames request the faster bit rate.
bool encode(const Message& message, std::span<const double> values, std::uint8_t counter, hal::CanFrame& frame) noexcept;

/// Writes the check of a frame after a change of its bytes.
void put_check(const Message& message, hal::CanFrame& frame) noexcept;

/// Follows the counter of a message.
class Sequence {
 public:
  /// Relation of a counter to the one before it: the first one, the next, the same again, or later by more than one.
  enum class Step : std::uint8_t { first, next, repeated, skipped };

  Step see(std::uint8_t counter) noexcept {
    const auto ahead = static_cast<std::uint8_t>(counter - last_);
    const Step step = !seen_ ? Step::first : ahead == 1 ? Step::next : ahead == 0 ? Step::repeated : Step::skipped;
    lost_ += step == Step::skipped ? ahead - 1U : 0U;
    last_ = counter;
    seen_ = true;
    return step;
  }

  /// Number of counter values that were left out; a counter that goes back counts as nearly all of 256.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::uint8_t last_ = 0;
  bool seen_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace hotfire::firmware::can
