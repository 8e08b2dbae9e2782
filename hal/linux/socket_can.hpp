// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/can_node.hpp"
#include "hal/failure.hpp"

namespace hotfire::hal {

/// A raw SocketCAN socket (`CanBus`), classic or FD.
///
/// Only subscribed ids reach the program (exact filters, remote frames out), set before the socket is bound. One `recvmmsg`
/// a cycle empties the socket: its buffer is kept small enough for that, and what a late cycle loses is counted by
/// SO_RXQ_OVFL. Frames carry the kernel's arrival stamp, CLOCK_REALTIME, converted to CLOCK_MONOTONIC with the offset of the
/// same `receive`; in the first milliseconds after `open` the kernel may stamp on reading instead.
///
/// A frame is pending from `try_send` until the driver echoes it as sent, so that at most one frame of an id waits below the
/// program, wherever that is: no set-point is ever sent behind an older one. A bus without a partner that acknowledges keeps
/// one frame of an id pending; `stop` takes the interface down if that is so, which alone empties the controller's own
/// buffers, and needs CAP_NET_ADMIN.
class SocketCan : public OnCanNode {
 public:
  struct Settings {
    std::string interface;                       ///< "can0"
    std::vector<CanSubscription> subscriptions;  ///< kMaxCanSubscriptions at most
    std::vector<CanId> senders;                  ///< ids that are sent, kMaxCanSenders at most
    bool fd = false;                             ///< FD frames are sent; received they are in any case
  };

  explicit SocketCan(Settings settings);
  ~SocketCan();
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;

  /// Opens and binds the socket. To be called once, before the memory is locked.
  std::optional<Failure> open() noexcept;

  void receive(std::int64_t now_ns) noexcept;
  CanSend try_send(const CanFrame& frame) noexcept;
  bool stop() noexcept;
  bool rearm() noexcept;

  /// Whether `stop` may take the interface down: the kernel is asked to set the flags that are set, which changes nothing
  /// and needs the same permission.
  bool may_take_interface_down() noexcept;

  /// CLOCK_REALTIME minus CLOCK_MONOTONIC at the last `receive` [ns]: what a recorder needs to match a candump log with
  /// edges of GPIO lines.
  std::int64_t realtime_offset_ns() const noexcept { return realtime_offset_ns_; }

 private:
  struct Batch;

  std::optional<Failure> configure() noexcept;
  std::optional<Failure> bind_to_interface() noexcept;
  bool set_filters() noexcept;
  void take_message(std::size_t i, std::int64_t now_ns) noexcept;
  void take_error_frame(std::uint32_t classes, const std::uint8_t* data) noexcept;
  void note_error(int error) noexcept;
  bool interface_is_up() noexcept;
  bool take_interface_down() noexcept;

  Settings settings_;
  std::unique_ptr<Batch> batch_;  ///< what recvmmsg fills
  int socket_ = -1;
  std::uint32_t dropped_before_ = 0;
  std::int64_t realtime_offset_ns_ = 0;
};

static_assert(CanBus<SocketCan>);

}  // namespace hotfire::hal
