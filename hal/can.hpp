// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace hotfire::hal {

inline constexpr std::size_t kMaxCanData = 64;
inline constexpr std::size_t kMaxCanSubscriptions = 32;
inline constexpr std::size_t kMaxCanSenders = 32;
/// Frames that one `receive` takes in.
inline constexpr std::size_t kMaxCanArrivals = 256;

/// The identifier of a frame: 11 bits, or 29 if extended.
struct CanId {
  std::uint32_t value = 0;
  bool extended = false;
  friend bool operator==(const CanId&, const CanId&) = default;
};

/// A data frame, classic (up to 8 bytes) or FD (up to 64). Remote frames are not used.
struct CanFrame {
  CanId id;
  bool fd = false;
  bool bit_rate_switch = false;  ///< FD only: the data at the faster rate
  std::uint8_t length = 0;       ///< bytes of `data` in use; FD allows 0 to 8, 12, 16, 20, 24, 32, 48, 64
  std::array<std::uint8_t, kMaxCanData> data{};

  std::span<const std::uint8_t> bytes() const noexcept { return {data.data(), length}; }
};

/// A frame that a program receives. A frame of the other format (classic, FD) under the same id is not received.
struct CanSubscription {
  CanId id;
  bool fd = false;
  std::int64_t age_limit_ns = std::numeric_limits<std::int64_t>::max();
};

/// The newest frame of a subscription.
struct CanMailbox {
  CanFrame frame;
  std::int64_t arrived_ns = 0;   ///< on CLOCK_MONOTONIC, by the kernel's stamp
  std::uint64_t received = 0;    ///< frames so far; 0: `frame` is none
  std::uint64_t superseded = 0;  ///< of these, overtaken by a newer one before `receive` showed them
  bool fresh = false;            ///< arrived by the last `receive`
};

/// A frame that a `receive` has taken in.
struct CanArrival {
  std::size_t subscription = 0;  ///< of which it is
  CanFrame frame;
  std::int64_t arrived_ns = 0;  ///< on CLOCK_MONOTONIC, by the kernel's stamp
};

/// The state of a bus, best first. Bus-off and down stay until a person's `rearm`, even if the bus recovers.
enum class CanState : std::uint8_t { good, warning, passive, bus_off, down };
inline constexpr std::array<const char*, 5> kCanStates{"good", "warning", "passive", "bus-off", "down"};

struct CanCounters {
  std::uint64_t received = 0;       ///< frames of a subscription
  std::uint64_t superseded = 0;     ///< of these, overtaken by a newer one before they were seen
  std::uint64_t foreign = 0;        ///< of a subscribed id, but the other format or cut short
  std::uint64_t impostors = 0;      ///< of an id that this node sends, from another node
  std::uint64_t dropped = 0;        ///< by the kernel because `receive` was called too late
  std::uint64_t error_frames = 0;   ///< reports of the controller
  std::uint64_t sent = 0;           ///< handed to the bus
  std::uint64_t confirmed = 0;      ///< of these, known to be out
  std::uint64_t pending = 0;        ///< not sent: the last frame of that id is not out yet
  std::uint64_t queue_full = 0;     ///< not sent: ENOBUFS
  std::uint64_t unusable = 0;       ///< not sent: bus-off, down or stopped
  std::uint64_t state_changes = 0;  ///< of CanState
};

/// Result of an attempt to send a frame.
enum class CanSend : std::uint8_t { taken, pending, queue_full, unusable };

/// One bus of a cyclic program.
///
/// - `receive(now_ns)`: takes all frames that have arrived; `now_ns` is the loop's time. Call it once a cycle. Never blocks;
///   bounded.
/// - `mailbox(i)`: the newest frame of subscription `i`; older ones are dropped and counted.
/// - `arrivals()`: every frame of a subscription that the last `receive` took, oldest first. A program can therefore also
///   check frames that a newer one supersedes. Frames beyond kMaxCanArrivals are dropped and counted.
/// - `in_time(i, now_ns)`: there is a frame, and it is not older than its age limit.
/// - `try_send(frame)`: gives the frame to the bus now, or drops it and returns the reason. Never blocks, never queues
///   behind an older frame of the same id, never retries: the next cycle has a newer one. The id is one of those named at
///   set-up.
/// - `state()`, `counters()`: since set-up. After bus-off and down, `try_send` refuses.
/// - `anything_pending()`: the bus has not confirmed every frame that it was given.
/// - `stop()`: no frame that was given to the bus leaves after its return; false if that cannot be ensured. Call it outside
///   the cycle, because it may block. `try_send` then refuses.
/// - `rearm()`: a person's decision to use the bus again after bus-off, down or `stop`; false if it is still down. Call it
///   outside the cycle.
///
/// All except `stop` and `rearm` without allocation, lock or exception.
template <class B>
concept CanBus = requires(B& bus, const B& seen, const CanFrame& frame, std::size_t i, std::int64_t now_ns) {
  { bus.receive(now_ns) }
  noexcept->std::same_as<void>;
  { seen.mailbox(i) }
  noexcept->std::same_as<const CanMailbox&>;
  { seen.arrivals() }
  noexcept->std::same_as<std::span<const CanArrival>>;
  { seen.in_time(i, now_ns) }
  noexcept->std::same_as<bool>;
  { bus.try_send(frame) }
  noexcept->std::same_as<CanSend>;
  { seen.state() }
  noexcept->std::same_as<CanState>;
  { seen.counters() }
  noexcept->std::same_as<const CanCounters&>;
  { seen.anything_pending() }
  noexcept->std::same_as<bool>;
  { bus.stop() }
  noexcept->std::same_as<bool>;
  { bus.rearm() }
  noexcept->std::same_as<bool>;
};

}  // namespace hotfire::hal
