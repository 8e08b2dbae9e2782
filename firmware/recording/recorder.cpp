// SPDX-License-Identifier: Apache-2.0
#include "firmware/recording/recorder.hpp"

#include <chrono>
#include <cstring>

namespace hotfire::firmware {

Recorder::Recorder(hal::RecordingSink& sink, std::size_t actuators, std::size_t readings, std::size_t slots)
    : sink_(sink), ring_(hal::cycle_bytes(actuators, readings), slots) {}

Recorder::~Recorder() {
  if (thread_.running()) {
    close();
  }
}

std::optional<hal::Failure> Recorder::start() {
  return thread_.start([this] { empty_until_closed(); });
}

void Recorder::record(const hal::CycleHead& head, std::span<const double> commands,
                      std::span<const double> readings) noexcept {
  ++offered_;
  std::byte* slot = refused_.load(std::memory_order_relaxed) ? nullptr : ring_.try_claim();
  if (slot == nullptr) {
    ++dropped_;
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
  thread_.join();
  hal::BlockHead end;
  end.kind = hal::BlockHead::kEnd;
  end.dropped = offered_ - stored_;
  append(end, {});
  sync();
  return {offered_, stored_, failure_, is_error_};
}

void Recorder::empty_until_closed() {
  using SteadyClock = std::chrono::steady_clock;
  SteadyClock::time_point synced = SteadyClock::now();
  for (bool closing = false; !closing;) {
    {
      std::unique_lock lock(mutex_);
      closing = close_asked_.wait_for(lock, std::chrono::nanoseconds(kEmptyEveryNs), [this] { return closing_; });
    }
    empty_ring();
    if (SteadyClock::now() - synced > std::chrono::nanoseconds(kSyncEveryNs)) {
      sync();
      synced = SteadyClock::now();
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
  keep(sink_.append(std::as_bytes(std::span(&head, 1)), content));
}

void Recorder::sync() { keep(sink_.sync()); }

void Recorder::keep(const std::optional<hal::SinkRefusal>& refusal) {
  if (refusal && (failure_.empty() || (refusal->is_error && !is_error_))) {
    failure_ = refusal->why;
    is_error_ = refusal->is_error;
    refused_.store(true, std::memory_order_relaxed);
  }
}

}  // namespace hotfire::firmware
