// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "hal/ordinary_thread.hpp"
#include "hal/service_manager.hpp"

namespace hotfire::firmware {

/// Reports the loop's own heartbeat to the service manager: READY=1 at the first beat, WATCHDOG=1 only while it continues,
/// STOPPING=1 at the end. A loop that hangs sends no message, and the manager ends it, even if this thread still runs.
class Watchdog {
 public:
  /// Interval of the check if the manager has no watchdog.
  static constexpr std::uint64_t kLookEveryUs = 500'000;

  /// `heartbeat` is counted up by the loop.
  Watchdog(hal::ServiceManager manager, const std::atomic<std::uint64_t>& heartbeat)
      : manager_(std::move(manager)), heartbeat_(heartbeat) {}
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Starts the checks, four times in the manager's interval; does nothing without a manager. Call it before the real-time
  /// set-up of the calling thread.
  std::optional<hal::Failure> start();

  /// Ends the checks, and reports the end of the loop.
  void stop();

  /// How often it has looked.
  std::uint64_t looks() const noexcept { return looks_.load(); }

 private:
  void look_until_stopped(std::uint64_t every_us);
  void look();

  hal::ServiceManager manager_;
  const std::atomic<std::uint64_t>& heartbeat_;
  std::uint64_t last_beat_ = 0;
  bool ready_ = false;
  std::atomic<std::uint64_t> looks_{0};
  std::mutex mutex_;
  std::condition_variable stop_asked_;
  bool stopping_ = false;
  hal::OrdinaryThread thread_;
};

}  // namespace hotfire::firmware
