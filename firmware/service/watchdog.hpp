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

/// Reports to the service manager what the loop's own heartbeat says: READY=1 when it first beats, WATCHDOG=1 only while it
/// goes on beating, STOPPING=1 at the end. A loop that hangs is silent, and the manager ends it, however well this thread
/// does.
class Watchdog {
 public:
  /// How often to look where the manager has no watchdog.
  static constexpr std::uint64_t kLookEveryUs = 500'000;

  /// `heartbeat` is counted up by the loop.
  Watchdog(hal::ServiceManager manager, const std::atomic<std::uint64_t>& heartbeat)
      : manager_(std::move(manager)), heartbeat_(heartbeat) {}
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Starts to look, four times in the manager's interval; nothing without a manager. Before the real-time set-up of the
  /// calling thread.
  std::optional<hal::Failure> start();

  /// Looks no more, and says that the loop has ended.
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
