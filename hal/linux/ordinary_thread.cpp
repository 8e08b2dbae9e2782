// SPDX-License-Identifier: Apache-2.0
#include "hal/ordinary_thread.hpp"

#include <csignal>
#include <cstring>
#include <string>

namespace hotfire::hal {

OrdinaryThread::~OrdinaryThread() { join(); }

std::optional<Failure> OrdinaryThread::start(std::function<void()> body) {
  constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
  body_ = std::move(body);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&attributes, SCHED_OTHER);
  // A signal to the process is for the loop's thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const auto run = [](void* own) -> void* {
    static_cast<OrdinaryThread*>(own)->body_();
    return nullptr;
  };
  const int error = pthread_create(&thread_, &attributes, run, this);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  running_ = error == 0;
  if (!running_) {
    return Failure{std::string("no thread beside the loop: pthread_create: ") + std::strerror(error),
                   "allow more threads: 'ulimit -u', TasksMax= in a systemd unit"};
  }
  return std::nullopt;
}

void OrdinaryThread::join() {
  if (running_) {
    pthread_join(thread_, nullptr);
    running_ = false;
  }
}

}  // namespace hotfire::hal
