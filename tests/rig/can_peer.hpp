// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/rig/raw_can.hpp"

namespace hotfire::test {

/// The other side of the bus: a plain socket that sends and sees everything, what it sent itself too.
class CanPeer {
 public:
  CanPeer() : socket_(SOCK_NONBLOCK) {
    const int on = 1;
    setsockopt(socket_.file, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    setsockopt(socket_.file, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof on);
    const can_err_mask_t errors = CAN_ERR_MASK;
    setsockopt(socket_.file, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    const int room = 1 << 22;
    setsockopt(socket_.file, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
  }

  void send(canid_t id, std::uint8_t first, std::size_t size = CAN_MTU) {
    canfd_frame frame{};
    frame.can_id = id;
    frame.len = size == CAN_MTU ? 8 : 64;
    frame.data[0] = first;
    put(frame, size);
  }

  void report(canid_t classes, std::uint8_t controller) {
    canfd_frame frame{};
    frame.can_id = CAN_ERR_FLAG | classes;
    frame.len = CAN_ERR_DLC;
    frame.data[1] = controller;
    put(frame, CAN_MTU);
  }

  /// True once the kernel has delivered every frame of this side.
  bool is_delivered() {
    look();
    return delivered_ == sent_;
  }

  /// How many frames of the other side arrived that `seen` has not given.
  std::size_t arrived() {
    look();
    return others_.size();
  }

  /// First bytes of the frames of the other side that were seen since the last call.
  std::vector<int> seen() {
    look();
    return std::exchange(others_, {});
  }

 private:
  void put(const canfd_frame& frame, std::size_t size) {
    CHECK_EQUAL(static_cast<ssize_t>(size), write(socket_.file, &frame, size));
    ++sent_;
  }

  void look() {
    for (;;) {
      canfd_frame frame{};
      iovec place{&frame, sizeof frame};
      msghdr message{};
      message.msg_iov = &place;
      message.msg_iovlen = 1;
      const ssize_t size = recvmsg(socket_.file, &message, 0);
      if (size < 0 && errno != ENETDOWN) {
        return;
      }
      if (size > 0 && (message.msg_flags & MSG_CONFIRM) != 0) {
        ++delivered_;
      } else if (size > 0) {
        others_.push_back(frame.data[0]);
      }
    }
  }

  RawCan socket_;
  std::size_t sent_ = 0;
  std::size_t delivered_ = 0;
  std::vector<int> others_{};
};

}  // namespace hotfire::test
