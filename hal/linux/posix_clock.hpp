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

}  // namespace hotfire::hal
