// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/can.hpp"
#include "hal/failure.hpp"

namespace hotfire::hal {

/// Waits for the frames of one message on a SocketCAN interface, with a socket of its own. The socket of the cycle keeps the
/// frames that arrive meanwhile.
class SocketCanListener {
 public:
  SocketCanListener(std::string interface, const CanSubscription& wanted)
      : interface_(std::move(interface)), wanted_(wanted) {}
  ~SocketCanListener();
  SocketCanListener(const SocketCanListener&) = delete;
  SocketCanListener& operator=(const SocketCanListener&) = delete;

  /// Call it once, after a `SocketCan` on the same interface has been opened, which refuses unsuitable interfaces.
  std::optional<Failure> open() noexcept;

  /// The oldest frame that was not returned yet, and its arrival on CLOCK_MONOTONIC. Blocks until the absolute time
  /// `deadline_ns` of that clock, and not at all if it has passed. False if there is no frame. It waits while a bus is down.
  /// A signal does not interrupt it. Without allocation, lock or exception.
  bool wait_for_frame(std::int64_t deadline_ns, CanFrame& frame, std::int64_t& arrival_ns) noexcept;

 private:
  bool take(CanFrame& frame, std::int64_t& arrival_ns) noexcept;

  std::string interface_;
  CanSubscription wanted_;
  int socket_ = -1;
};

}  // namespace hotfire::hal
