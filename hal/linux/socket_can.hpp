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
/// Only subscribed ids reach the program (exact filters, no remote frames); the filters are set before the socket is bound.
/// One `recvmmsg` a cycle empties the socket, whose buffer is small enough for that. SO_RXQ_OVFL counts the frames that a
/// late cycle loses. Frames carry the kernel's arrival stamp, CLOCK_REALTIME, converted to CLOCK_MONOTONIC with the offset
/// of the same `receive`. In the first milliseconds after `open` the kernel may stamp a frame when it is read.
///
/// A frame is pending from `try_send` until the driver echoes it as sent. At most one frame of an id therefore waits below
/// the program, in kernel or controller: no set-point is ever sent behind an older one. On a bus without an acknowledging
/// partner, one frame of an id stays pending. `stop` then takes the interface down, which is the only way to empty the
/// controller's own buffers. It needs CAP_NET_ADMIN.
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

  /// Opens and binds the socket. Call it once, before the memory is locked.
  std::optional<Failure> open() noexcept;

  void receive(std::int64_t now_ns) noexcept;
  CanSend try_send(const CanFrame& frame) noexcept;
  bool stop() noexcept;
  bool rearm() noexcept;

  /// Whether `stop` may take the interface down. The kernel is asked to set the flags that are already set. This changes
  /// nothing and needs the same permission.
  bool may_take_interface_down() noexcept;

  /// CLOCK_REALTIME minus CLOCK_MONOTONIC at the last `receive` [ns]. With it a recorder matches a candump log with edges of
  /// GPIO lines.
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
