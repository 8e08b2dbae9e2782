// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "hal/clock.hpp"

namespace hotfire::hal::sim {

/// A clock that moves only on request (`Clock`). It tests timing logic independently of the machine's timing. A sleep jumps
/// to its end, plus a lateness that a test may inject once.
class ManualClock {
 public:
  std::int64_t now_ns() const noexcept { return now_ns_; }

  void sleep_until_ns(std::int64_t time_ns) noexcept {
    now_ns_ = std::max(now_ns_, time_ns) + lateness_ns_;
    lateness_ns_ = 0;
    ++sleeps_;
  }

  void advance_ns(std::int64_t duration_ns) noexcept { now_ns_ += duration_ns; }

  /// The next sleep ends this much too late.
  void delay_next_wake_up_ns(std::int64_t lateness_ns) noexcept { lateness_ns_ = lateness_ns; }

  std::uint64_t sleeps() const noexcept { return sleeps_; }

 private:
  std::int64_t now_ns_ = 0;
  std::int64_t lateness_ns_ = 0;
  std::uint64_t sleeps_ = 0;
};

static_assert(Clock<ManualClock>);

}  // namespace hotfire::hal::sim
