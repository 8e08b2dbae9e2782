// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "firmware/recording/recording_ring.hpp"
#include "hal/ordinary_thread.hpp"
#include "hal/recording/format.hpp"
#include "hal/recording/sink.hpp"

namespace hotfire::firmware {

/// Counts of the cycles that a recorder received: offered = stored + dropped, exactly.
struct RecorderAccount {
  std::uint64_t offered = 0;
  std::uint64_t stored = 0;
  std::string failure;    ///< why the recording ended before the loop; empty: it did not
  bool is_error = false;  ///< it ended because the disk failed, and not at a limit that was asked for

  std::uint64_t dropped() const noexcept { return offered - stored; }
};

/// Takes cycles from a real-time loop and gives them to a sink in a thread of its own, which is not real-time. A ring is
/// between the two. If the sink is slower than the loop until the ring is full, cycles are dropped and counted. The first
/// refusal of the sink, to append or to make safe, ends the recording: every cycle from then on is dropped.
class Recorder {
 public:
  /// Interval in which the thread empties the ring. A killed process loses no more than this and one write.
  static constexpr std::int64_t kEmptyEveryNs = 50'000'000;
  /// Interval in which the written data are made safe from a loss of power.
  static constexpr std::int64_t kSyncEveryNs = 1'000'000'000;

  /// `slots`: cycles that the ring holds.
  Recorder(hal::RecordingSink& sink, std::size_t actuators, std::size_t readings, std::size_t slots);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Starts the thread. Before the real-time set-up of the calling thread.
  std::optional<hal::Failure> start();

  /// Real-time, wait-free: copies the cycle into the ring, or drops it.
  void record(const hal::CycleHead& head, std::span<const double> commands, std::span<const double> readings) noexcept;

  /// True once a cycle has been dropped, because the ring was full or the sink refused it. Real-time.
  bool dropping() const noexcept { return dropped_ > 0; }

  /// Cycles that the recorder received, those that found no room, those that wait for the thread, and the room for them.
  /// Call it from the loop. Real-time.
  std::uint64_t offered() const noexcept { return offered_; }
  std::uint64_t dropped() const noexcept { return dropped_; }
  std::size_t waiting() const noexcept { return ring_.waiting(); }
  std::size_t room() const noexcept { return ring_.slots(); }

  /// Writes the rest of the ring and the end of the recording, and ends the thread. Not real-time. Call it once.
  RecorderAccount close();

 private:
  void empty_until_closed();
  void empty_ring();
  void append(hal::BlockHead& head, std::span<const std::byte> content);
  void sync();
  void keep(const std::optional<hal::SinkRefusal>& refusal);

  hal::RecordingSink& sink_;
  RecordingRing ring_;
  std::uint64_t offered_ = 0;  ///< the loop's own
  std::uint64_t dropped_ = 0;  ///< the loop's own
  std::atomic<bool> refused_{false};
  std::uint64_t stored_ = 0;  ///< the thread's own
  std::string failure_;       ///< the thread's own
  bool is_error_ = false;     ///< the thread's own
  std::mutex mutex_;          ///< of `closing_`; the loop never takes it
  std::condition_variable close_asked_;
  bool closing_ = false;
  hal::OrdinaryThread thread_;
};

}  // namespace hotfire::firmware
