#include "firmware/recorder.hpp"

#include <csignal>

#include <chrono>
#include <cstring>

namespace hotfire::firmware {

Recorder::Recorder(hal::RecordingSink& sink, std::size_t actuators, std::size_t readings, std::size_t slots)
    : sink_(sink), ring_(hal::cycle_bytes(actuators, readings), slots) {}

Recorder::~Recorder() {
  if (running_) {
    close();
  }
}

std::optional<hal::Failure> Recorder::start() {
  // Locked memory counts all of a stack, and the default is 8 MiB.
  constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
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
  const int error = pthread_create(&thread_, &attributes, &Recorder::run, this);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_attr_destroy(&attributes);
  running_ = error == 0;
  if (!running_) {
    return hal::Failure{std::string("no recording: pthread_create: ") + std::strerror(error),
                        "allow more threads: 'ulimit -u', TasksMax= in a systemd unit"};
  }
  return std::nullopt;
}

void Recorder::record(const hal::CycleHead& head, std::span<const double> commands,
                      std::span<const double> readings) noexcept {
  ++offered_;
  std::byte* slot = refused_.load(std::memory_order_relaxed) ? nullptr : ring_.try_claim();
  if (slot == nullptr) {
    dropping_ = true;
    return;
  }
  std::memcpy(slot, &head, sizeof head);
  std::memcpy(slot + sizeof head, commands.data(), commands.size_bytes());
  std::memcpy(slot + sizeof head + commands.size_bytes(), readings.data(), readings.size_bytes());
  ring_.publish();
}

RecorderAccount Recorder::close() {
  {
    const std::lock_guard guard(mutex_);
    closing_ = true;
  }
  close_asked_.notify_one();
  pthread_join(thread_, nullptr);
  running_ = false;
  hal::BlockHead end;
  end.kind = hal::BlockHead::kEnd;
  end.dropped = offered_ - stored_;
  append(end, {});
  sink_.sync();
  return {offered_, stored_, failure_};
}

void* Recorder::run(void* recorder) {
  static_cast<Recorder*>(recorder)->empty_until_closed();
  return nullptr;
}

void Recorder::empty_until_closed() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point synced = Clock::now();
  for (bool closing = false; !closing;) {
    {
      std::unique_lock lock(mutex_);
      closing = close_asked_.wait_for(lock, std::chrono::nanoseconds(kEmptyEveryNs), [this] { return closing_; });
    }
    empty_ring();
    if (Clock::now() - synced > std::chrono::nanoseconds(kSyncEveryNs)) {
      sink_.sync();
      synced = Clock::now();
    }
  }
}

void Recorder::empty_ring() {
  for (;;) {
    const std::span<const std::byte> content = ring_.filled(hal::kMostCyclesOfBlock);
    if (content.empty()) {
      return;
    }
    hal::BlockHead head;
    head.cycles = static_cast<std::uint32_t>(content.size() / ring_.slot_bytes());
    if (failure_.empty()) {
      append(head, content);
      stored_ += failure_.empty() ? head.cycles : 0;
    }
    ring_.release(head.cycles);
  }
}

void Recorder::append(hal::BlockHead& head, std::span<const std::byte> content) {
  head.checksum = head.checksum_with(content);
  const std::string why = sink_.append(std::as_bytes(std::span(&head, 1)), content);
  if (!why.empty() && failure_.empty()) {
    failure_ = why;
    refused_.store(true, std::memory_order_relaxed);
  }
}

}  // namespace hotfire::firmware
