// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>

namespace hotfire::hal {

/// The clock of the loop.
///
/// - `now_ns()`: monotonic, never set by anyone, with the same origin for the life of the process. Does not block.
/// - `sleep_until_ns(t)`: returns at or after the absolute time `t`, at once if it has passed. A signal does not interrupt
///   it. The only call of the loop that blocks.
///
/// Both without allocation, lock or exception.
template <class C>
concept Clock = requires(C& clock, std::int64_t time_ns) {
  { clock.now_ns() }
  noexcept->std::same_as<std::int64_t>;
  { clock.sleep_until_ns(time_ns) }
  noexcept->std::same_as<void>;
};

}  // namespace hotfire::hal
