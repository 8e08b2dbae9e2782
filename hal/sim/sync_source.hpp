// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/clock.hpp"
#include "hal/sync_source.hpp"

namespace hotfire::hal::sim {

/// Syncs at a steady period on any clock (`hal::SyncSource`), so that a locked loop runs without a wire. Their period may
/// differ from that of the loop, as on a real rig.
template <Clock C>
class SimulatedSyncSource {
 public:
  SimulatedSyncSource(C& clock, std::int64_t period_ns) noexcept
      : clock_(clock), period_ns_(period_ns), next_ns_(clock.now_ns() + period_ns) {}

  bool wait_for_sync(std::int64_t deadline_ns, Sync& sync) noexcept {
    if (next_ns_ > deadline_ns || silent_) {
      clock_.sleep_until_ns(deadline_ns);
      return false;
    }
    clock_.sleep_until_ns(next_ns_);
    const std::int64_t over = (clock_.now_ns() - next_ns_) / period_ns_;
    sync.arrival_ns = next_ns_ + over * period_ns_;
    sync.superseded = static_cast<std::uint64_t>(over);
    next_ns_ = sync.arrival_ns + period_ns_;
    return true;
  }

  /// From now on no sync comes, or the syncs come again on their old grid.
  void set_silent(bool silent) noexcept {
    silent_ = silent;
    while (!silent && next_ns_ <= clock_.now_ns()) {
      next_ns_ += period_ns_;
    }
  }

 private:
  C& clock_;
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  bool silent_ = false;
};

}  // namespace hotfire::hal::sim
