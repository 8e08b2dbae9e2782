// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/can/can_map.hpp"
#include "firmware/can/message_follower.hpp"
#include "hal/sync_source.hpp"

namespace hotfire::firmware::can {

/// The SYNC frames of a bus as the trigger of a loop (`hal::SyncSource`). A frame with a wrong check, or one that repeats
/// the previous one, is not a sync. `Frames` has `wait_for_frame(deadline_ns, frame, arrival_ns)`.
template <class Frames>
class CanSyncSource {
 public:
  explicit CanSyncSource(Frames& frames) noexcept : frames_(frames) {}

  bool wait_for_sync(std::int64_t deadline_ns, hal::Sync& sync) noexcept {
    bool found = false;
    for (std::size_t i = 0; i < kMostAtOnce; ++i) {
      hal::CanFrame frame;
      std::int64_t arrival_ns = 0;
      if (!frames_.wait_for_frame(found ? kAtOnce : deadline_ns, frame, arrival_ns)) {
        break;
      }
      if (syncs_.take(sync::kMessage, frame, {})) {
        sync.superseded = found ? sync.superseded + 1 : 0;
        sync.arrival_ns = arrival_ns;
        found = true;
      }
    }
    if (!found) {
      // A controller that starts anew counts from its own beginning.
      syncs_.forget();
    }
    return found;
  }

  const MessageCounters& counters() const noexcept { return syncs_.counters(); }

 private:
  static constexpr std::int64_t kAtOnce = 0;
  static constexpr std::size_t kMostAtOnce = 1024;

  Frames& frames_;
  MessageFollower syncs_;
};

}  // namespace hotfire::firmware::can
