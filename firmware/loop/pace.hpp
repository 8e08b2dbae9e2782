// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/sync_source.hpp"

namespace hotfire::firmware {

/// The cause of the start of a cycle.
struct Wake {
  std::int64_t release_ns = 0;  ///< when it was due
  std::int64_t woken_ns = 0;
  bool slept = false;  ///< false if it was already due when it was asked for
};

// What gives a loop its cycles, a `Pace`:
// - `wait(wake)`: blocks until a cycle is due, at once if one already is. False if none came for now: the loop looks whether
//   it is asked to stop, and asks again.
// - `drop_overdue(written_ns)`: leaves out the cycles that are due at that time, and returns how many these are.
// - `lost()`: no cycle will come any more that the rest of the rig would agree on.
//
// All without allocation, lock or exception.

/// Cycles at absolute times of the loop's own clock. The schedule does not drift with the work, and keeps its phase if
/// cycles are left out.
template <hal::Clock Clock>
class OwnPace {
 public:
  OwnPace(Clock& clock, std::int64_t period_ns) noexcept : clock_(clock), period_ns_(period_ns) {}

  bool wait(Wake& wake) noexcept {
    wake.woken_ns = clock_.now_ns();
    next_ns_ = next_ns_ == 0 ? wake.woken_ns + period_ns_ : next_ns_;
    wake.release_ns = next_ns_;
    wake.slept = wake.woken_ns < next_ns_;
    if (wake.slept) {
      clock_.sleep_until_ns(next_ns_);
      wake.woken_ns = clock_.now_ns();
    }
    next_ns_ += period_ns_;
    return true;
  }

  std::uint64_t drop_overdue(std::int64_t written_ns) noexcept {
    if (written_ns <= next_ns_) {
      return 0;
    }
    const std::int64_t missed = (written_ns - next_ns_ + period_ns_ - 1) / period_ns_;
    next_ns_ += missed * period_ns_;
    return static_cast<std::uint64_t>(missed);
  }

  static constexpr bool lost() noexcept { return false; }
  static constexpr std::uint64_t missed_syncs() noexcept { return 0; }

 private:
  Clock& clock_;
  std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;  ///< 0: not begun
};

/// Cycles at external syncs, one for each sync. The plant follows the rig, and its time is counted in syncs.
///
/// The arrival of a sync releases its cycle. A sync is missed if it has not come by the patience after its due time. Its
/// cycle then runs without it, on the schedule of the last one, so that a lost frame takes no period from the plant's time.
/// A sync within half a period later still belongs to that cycle. After that it is an early sync of the next cycle. After
/// more than `most_missed` in a row the pace is lost. Syncs that arrive during an overrun run one after the other, or
/// `drop_overdue` leaves them out.
template <hal::Clock Clock, hal::SyncSource Source>
class SyncPace {
 public:
  static constexpr std::int64_t kLongestWaitNs = 100'000'000;

  SyncPace(Clock& clock, Source& source, std::int64_t period_ns, std::uint64_t most_missed,
           std::int64_t patience_ns) noexcept
      : clock_(clock), source_(source), period_ns_(period_ns), most_missed_(most_missed), patience_ns_(patience_ns) {}

  bool wait(Wake& wake) noexcept {
    const std::int64_t now = clock_.now_ns();
    if (last_ns_ == 0) {
      return first(wake, now);
    }
    const std::int64_t due = last_ns_ + period_ns_;
    if (behind_ > 0) {
      --behind_;
      return begin(wake, due, now, false);
    }
    hal::Sync sync;
    for (bool looking = true; looking;) {
      const std::int64_t given_up = due + patience_ns_;
      const std::int64_t slice_end = std::min(given_up, clock_.now_ns() + kLongestWaitNs);
      if (!source_.wait_for_sync(slice_end, sync)) {
        if (slice_end < given_up) {
          return false;
        }
        ++missed_;
        ++missed_in_a_row_;
        return begin(wake, due, clock_.now_ns(), false);
      }
      looking = missed_in_a_row_ > 0 && sync.superseded == 0 && sync.arrival_ns - last_ns_ < period_ns_ / 2;
    }
    missed_in_a_row_ = 0;
    behind_ = sync.superseded;
    const std::int64_t release = sync.arrival_ns - static_cast<std::int64_t>(behind_) * period_ns_;
    return begin(wake, release, clock_.now_ns(), now < release);
  }

  std::uint64_t drop_overdue(std::int64_t written_ns) noexcept {
    hal::Sync sync;
    std::uint64_t dropped = behind_;
    if (!source_.wait_for_sync(written_ns, sync)) {
      last_ns_ += static_cast<std::int64_t>(behind_) * period_ns_;
      behind_ = 0;
      return dropped;
    }
    // One that came after the writing, which it may answer, is the next cycle's and is not overdue.
    const bool is_next = sync.arrival_ns > written_ns;
    last_ns_ = is_next ? sync.arrival_ns - period_ns_ : sync.arrival_ns;
    behind_ = is_next ? 1 : 0;
    return dropped + sync.superseded + (is_next ? 0 : 1);
  }

  bool lost() const noexcept { return missed_in_a_row_ > most_missed_; }
  std::uint64_t missed_syncs() const noexcept { return missed_; }

 private:
  bool first(Wake& wake, std::int64_t now) noexcept {
    hal::Sync sync;
    return source_.wait_for_sync(now + kLongestWaitNs, sync) && begin(wake, sync.arrival_ns, clock_.now_ns(), true);
  }

  bool begin(Wake& wake, std::int64_t release, std::int64_t woken, bool slept) noexcept {
    wake = {release, std::max(woken, release), slept};
    last_ns_ = release;
    return true;
  }

  Clock& clock_;
  Source& source_;
  std::int64_t period_ns_;
  std::uint64_t most_missed_;
  std::int64_t patience_ns_;
  std::int64_t last_ns_ = 0;  ///< release of the last cycle; 0: no sync yet
  std::uint64_t behind_ = 0;  ///< cycles whose sync has come and that have not been run
  std::uint64_t missed_ = 0;
  std::uint64_t missed_in_a_row_ = 0;
};

/// Cycles that wait for an answer. They come at the period of the loop's own clock, but not before the plant has answered
/// the last one. The rig then runs as fast as its slowest part. No cycle is lost, and no part overruns because of another
/// one. `Answers` has `wait_for_frame(deadline_ns, frame, arrival_ns)`.
template <hal::Clock Clock, class Answers>
class LockstepPace {
 public:
  static constexpr std::int64_t kLongestWaitNs = 100'000'000;

  LockstepPace(Clock& clock, Answers& answers, std::int64_t period_ns) noexcept
      : clock_(clock), answers_(answers), period_ns_(period_ns) {}

  bool wait(Wake& wake) noexcept {
    hal::CanFrame frame;
    std::int64_t arrival = 0;
    if (begun_ && !answers_.wait_for_frame(clock_.now_ns() + kLongestWaitNs, frame, arrival)) {
      return false;
    }
    begun_ = true;
    const std::int64_t now = clock_.now_ns();
    wake.release_ns = std::max(now, next_ns_);
    wake.slept = now < next_ns_;
    if (wake.slept) {
      clock_.sleep_until_ns(next_ns_);
    }
    wake.woken_ns = clock_.now_ns();
    next_ns_ = wake.release_ns + period_ns_;
    return true;
  }

  static constexpr std::uint64_t drop_overdue(std::int64_t) noexcept { return 0; }
  static constexpr bool lost() noexcept { return false; }
  static constexpr std::uint64_t missed_syncs() noexcept { return 0; }

 private:
  Clock& clock_;
  Answers& answers_;
  std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;
  bool begun_ = false;
};

}  // namespace hotfire::firmware
