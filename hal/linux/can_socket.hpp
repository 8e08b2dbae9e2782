// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <limits>

#include "hal/can.hpp"

namespace hotfire::hal {

// What the CAN sockets of this folder have in common.

inline canid_t kernel_id(const CanId& id) noexcept {
  return id.extended ? (id.value & CAN_EFF_MASK) | CAN_EFF_FLAG : id.value & CAN_SFF_MASK;
}

/// Accepts frames of one id, and no remote frame.
inline can_filter exact_filter(const CanId& id) noexcept {
  return {kernel_id(id), (id.extended ? CAN_EFF_MASK : CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

template <class Value>
bool set_option(int socket, int level, int name, const Value& value) noexcept {
  return setsockopt(socket, level, name, &value, sizeof value) == 0;
}

inline std::int64_t nanoseconds(const timespec& time) noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return static_cast<std::int64_t>(time.tv_sec) * kSecond + time.tv_nsec;
}

inline std::int64_t read_clock(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return nanoseconds(time);
}

/// CLOCK_REALTIME less CLOCK_MONOTONIC [ns]. If another process runs between the two readings, every stamp of the kernel is
/// wrong by that time. Several attempts are made, and the one whose readings are closest together counts.
inline std::int64_t realtime_offset_ns() noexcept {
  constexpr int kAttempts = 4;
  constexpr std::int64_t kCloseEnough = 20'000;
  std::int64_t offset = 0;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < kAttempts && least > kCloseEnough; ++i) {
    const std::int64_t before = read_clock(CLOCK_MONOTONIC);
    const std::int64_t real = read_clock(CLOCK_REALTIME);
    const std::int64_t took = read_clock(CLOCK_MONOTONIC) - before;
    if (took < least) {
      least = took;
      offset = real - before - took / 2;
    }
  }
  return offset;
}

}  // namespace hotfire::hal
