// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "hal/clock.hpp"

namespace hotfire::hal {

/// CLOCK_MONOTONIC with absolute sleeps (`Clock`): the schedule does not drift with the time a cycle takes.
class PosixClock {
 public:
  std::int64_t now_ns() const noexcept {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return static_cast<std::int64_t>(time.tv_sec) * kSecond + time.tv_nsec;
  }

  void sleep_until_ns(std::int64_t time_ns) const noexcept {
    const timespec time{static_cast<time_t>(time_ns / kSecond), static_cast<long>(time_ns % kSecond)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
  }

 private:
  static constexpr std::int64_t kSecond = 1'000'000'000;
};

static_assert(Clock<PosixClock>);

/// CLOCK_REALTIME [ns]: the time of day. Other programs set it, and two machines can share it.
inline std::int64_t real_time_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

}  // namespace hotfire::hal
