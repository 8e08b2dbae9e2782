// SPDX-License-Identifier: Apache-2.0
#include "firmware/service/watchdog.hpp"

#include <chrono>

#include "firmware/text/text.hpp"

namespace hotfire::firmware {

Watchdog::~Watchdog() { stop(); }

std::optional<hal::Failure> Watchdog::start() {
  if (!manager_.listens()) {
    return std::nullopt;
  }
  const std::uint64_t every_us = manager_.watchdog_us() > 0 ? manager_.watchdog_us() / 4 : kLookEveryUs;
  return thread_.start([this, every_us] { look_until_stopped(every_us); });
}

void Watchdog::stop() {
  if (!thread_.running()) {
    return;
  }
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  stop_asked_.notify_one();
  thread_.join();
  manager_.notify("STOPPING=1");
}

void Watchdog::look_until_stopped(std::uint64_t every_us) {
  std::unique_lock lock(mutex_);
  while (!stop_asked_.wait_for(lock, std::chrono::microseconds(every_us), [this] { return stopping_; })) {
    look();
    looks_.fetch_add(1);
  }
}

void Watchdog::look() {
  const std::uint64_t beat = heartbeat_.load(std::memory_order_relaxed);
  if (beat == last_beat_) {
    return;
  }
  last_beat_ = beat;
  const std::string status = text("\nSTATUS=running, turn %llu of the loop", static_cast<unsigned long long>(beat));
  manager_.notify((ready_ ? "WATCHDOG=1" : "READY=1\nWATCHDOG=1") + status);
  ready_ = true;
}

}  // namespace hotfire::firmware
