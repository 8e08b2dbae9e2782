// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "firmware/can/codec.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

/// A message that is sent every n cycles of a loop, as often as the map says and at most once a cycle.
class PeriodicFrame {
 public:
  PeriodicFrame(const Message& message, std::int64_t period_ns) noexcept
      : message_(message), every_(std::max<std::int64_t>(1, message.cycle_ms * kMillisecond / period_ns)) {}

  /// Whether the frame is due in this cycle. Call it once a cycle.
  bool is_due() noexcept { return cycle_++ % every_ == 0; }

  /// Sends the frame with the next counter, even if the bus did not take the previous one. A receiver then detects the
  /// missing frame.
  template <hal::CanBus Bus>
  hal::CanSend send(Bus& bus, std::span<const double> values) noexcept {
    hal::CanFrame frame;
    return encode(message_, values, counter_++, frame) ? bus.try_send(frame) : hal::CanSend::unusable;
  }

 private:
  const Message& message_;
  std::int64_t every_;
  std::int64_t cycle_ = 0;
  std::uint8_t counter_ = 0;

  static constexpr std::int64_t kMillisecond = 1'000'000;
};

}  // namespace hotfire::firmware::can
