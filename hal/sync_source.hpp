// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>

namespace hotfire::hal {

/// The external trigger of a plant's cycles: a frame on a bus, a pulse on a line, or another clock of the rig.
struct Sync {
  std::int64_t arrival_ns = 0;   ///< CLOCK_MONOTONIC, of the newest one
  std::uint64_t superseded = 0;  ///< older ones that came since the last call and are passed over by it
};

/// - `wait_for_sync(deadline_ns, sync)`: the newest sync since the last call, at once if there is one. Otherwise it blocks
///   until one arrives. False, with `sync` unchanged, if none has arrived by the absolute time `deadline_ns` of
///   CLOCK_MONOTONIC. A signal does not interrupt it.
///
/// The only call of a locked loop that blocks. Without allocation, lock or exception.
template <class S>
concept SyncSource = requires(S& source, std::int64_t deadline_ns, Sync& sync) {
  { source.wait_for_sync(deadline_ns, sync) }
  noexcept->std::same_as<bool>;
};

}  // namespace hotfire::hal
