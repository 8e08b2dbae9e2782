// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <functional>
#include <optional>

#include "hal/realtime.hpp"

namespace hotfire::hal {

/// A thread beside a real-time loop, for work that may wait. It is an ordinary process on any CPU of this process, whatever
/// the thread that starts it is or becomes. It gets no signals. Its stack is small, because locked memory counts all of it.
class OrdinaryThread {
 public:
  OrdinaryThread() = default;
  ~OrdinaryThread();
  OrdinaryThread(const OrdinaryThread&) = delete;
  OrdinaryThread& operator=(const OrdinaryThread&) = delete;

  /// Call it before the calling thread is bound to a CPU. The body must not throw.
  std::optional<Failure> start(std::function<void()> body);

  /// Waits for the end of the body. Does nothing if it was not started.
  void join();

  bool running() const noexcept { return running_; }

 private:
  std::function<void()> body_;
  bool running_ = false;
  pthread_t thread_{};
};

}  // namespace hotfire::hal
