// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/socket_can_listener.hpp"

#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "hal/linux/can_socket.hpp"
#include "hal/linux/posix_clock.hpp"

namespace hotfire::hal {

SocketCanListener::~SocketCanListener() {
  if (socket_ >= 0) {
    close(socket_);
  }
}

std::optional<Failure> SocketCanListener::open() noexcept {
  const int on = 1;
  const can_filter filter = exact_filter(wanted_.id);
  socket_ = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface_.c_str()));
  if (socket_ < 0 || !set_option(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filter) ||
      (wanted_.fd && !set_option(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) ||
      !set_option(socket_, SOL_SOCKET, SO_TIMESTAMPNS, on) ||
      bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Failure{"no second socket on " + interface_ + ": " + std::strerror(errno),
                   "see 'ip -details link show " + interface_ + "'"};
  }
  return std::nullopt;
}

bool SocketCanListener::take(CanFrame& frame, std::int64_t& arrival_ns) noexcept {
  canfd_frame seen{};
  iovec part{&seen, sizeof seen};
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof(timespec))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  const ssize_t size = recvmsg(socket_, &header, MSG_DONTWAIT);
  if (size != static_cast<ssize_t>(wanted_.fd ? CANFD_MTU : CAN_MTU) ||
      seen.len > (wanted_.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN)) {
    return false;
  }
  const std::int64_t now_ns = read_clock(CLOCK_MONOTONIC);
  arrival_ns = now_ns;
  const cmsghdr* const stamp_part = CMSG_FIRSTHDR(&header);
  if (stamp_part != nullptr && stamp_part->cmsg_type == SO_TIMESTAMPNS) {
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(stamp_part), sizeof stamp);
    arrival_ns = std::min(now_ns, nanoseconds(stamp) - realtime_offset_ns());
  }
  frame = CanFrame{};
  frame.id = wanted_.id;
  frame.fd = wanted_.fd;
  frame.length = seen.len;
  std::copy_n(seen.data, seen.len, frame.data.begin());
  return true;
}

bool SocketCanListener::wait_for_frame(std::int64_t deadline_ns, CanFrame& frame, std::int64_t& arrival_ns) noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (;;) {
    if (take(frame, arrival_ns)) {
      return true;
    }
    const std::int64_t left_ns = deadline_ns - read_clock(CLOCK_MONOTONIC);
    if (left_ns <= 0) {
      return false;
    }
    pollfd ready{socket_, POLLIN, 0};
    const timespec timeout{static_cast<time_t>(left_ns / kSecond), static_cast<long>(left_ns % kSecond)};
    if (ppoll(&ready, 1, &timeout, nullptr) > 0 && (ready.revents & POLLIN) == 0) {
      // The interface is down: poll would report that again and again.
      PosixClock().sleep_until_ns(deadline_ns);
    }
  }
}

}  // namespace hotfire::hal
