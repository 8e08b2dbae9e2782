// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>

namespace hotfire::hal {

/// What a plant's cycles can be locked to: a frame on a bus, a pulse on a line, whatever the rest of the rig ticks by.
struct Sync {
  std::int64_t arrival_ns = 0;   ///< CLOCK_MONOTONIC, of the newest one
  std::uint64_t superseded = 0;  ///< older ones that came since the last call and are passed over by it
};

/// - `wait_for_sync(deadline_ns, sync)`: the newest sync that has arrived since the last call, at once if there is one; else
///   blocks until one arrives. False and `sync` untouched if none has by the absolute time `deadline_ns` of CLOCK_MONOTONIC.
///   A signal does not cut it short.
///
/// The only call of a locked loop that blocks. Without allocation, lock or exception.
template <class S>
concept SyncSource = requires(S& source, std::int64_t deadline_ns, Sync& sync) {
  { source.wait_for_sync(deadline_ns, sync) }
  noexcept->std::same_as<bool>;
};

}  // namespace hotfire::hal
