// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/socket_can.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hal/linux/can_socket.hpp"

namespace hotfire::hal {
namespace {

/// A classic frame costs its receiver at least 768 bytes of socket buffer, so that no more than kMostWaiting can wait in
/// kReceiveBuffer. The kernel doubles what is asked for.
constexpr int kReceiveBuffer = 192 * 1024;
constexpr std::size_t kMostWaiting = kMaxCanArrivals;
static_assert(kReceiveBuffer / 768 <= kMostWaiting);

constexpr can_err_mask_t kErrorClasses = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;

CanId our_id(canid_t id) {
  const bool extended = (id & CAN_EFF_FLAG) != 0;
  return {id & (extended ? CAN_EFF_MASK : CAN_SFF_MASK), extended};
}

bool is_interface_error(int error) { return error == ENETDOWN || error == ENODEV || error == ENXIO; }

}  // namespace

struct SocketCan::Batch {
  static constexpr std::size_t kControl = CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));
  struct alignas(cmsghdr) Control {
    std::array<std::uint8_t, kControl> bytes;
  };
  std::array<mmsghdr, kMostWaiting> headers{};
  std::array<iovec, kMostWaiting> parts{};
  std::array<canfd_frame, kMostWaiting> frames{};
  std::array<Control, kMostWaiting> controls{};
};

SocketCan::SocketCan(Settings settings)
    : OnCanNode(settings.subscriptions, settings.senders),
      settings_(std::move(settings)),
      batch_(std::make_unique<Batch>()) {
  for (std::size_t i = 0; i < kMostWaiting; ++i) {
    batch_->parts[i] = {&batch_->frames[i], sizeof(canfd_frame)};
    batch_->headers[i].msg_hdr.msg_iov = &batch_->parts[i];
    batch_->headers[i].msg_hdr.msg_iovlen = 1;
    batch_->headers[i].msg_hdr.msg_control = batch_->controls[i].bytes.data();
  }
}

SocketCan::~SocketCan() {
  if (socket_ >= 0) {
    close(socket_);
  }
}

std::optional<Failure> SocketCan::open() noexcept {
  if (settings_.subscriptions.size() > kMaxCanSubscriptions || settings_.senders.size() > kMaxCanSenders) {
    return Failure{std::to_string(settings_.subscriptions.size()) + " ids to receive and " +
                       std::to_string(settings_.senders.size()) + " to send",
                   "at most " + std::to_string(kMaxCanSubscriptions) + " and " + std::to_string(kMaxCanSenders)};
  }
  socket_ = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (socket_ < 0) {
    const bool forbidden = errno == EPERM || errno == EACCES;
    return forbidden ? failed_call("no permission to open a CAN socket", errno,
                                   "let the sandbox or container have AF_CAN sockets, or start without it")
                     : failed_call("no CAN in this kernel: socket", errno, "load it: 'modprobe can-raw'");
  }
  if (auto refused = configure()) {
    return refused;
  }
  return bind_to_interface();
}

bool SocketCan::set_filters() noexcept {
  std::array<can_filter, kMaxCanSubscriptions + kMaxCanSenders> filters{};
  std::size_t count = 0;
  for (const CanSubscription& subscription : settings_.subscriptions) {
    filters[count++] = exact_filter(subscription.id);
  }
  for (const CanId& id : settings_.senders) {
    filters[count++] = exact_filter(id);
  }
  return setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                    static_cast<socklen_t>(count * sizeof(can_filter))) == 0;
}

std::optional<Failure> SocketCan::configure() noexcept {
  const int on = 1;
  const int half = kReceiveBuffer / 2;
  if (!set_filters() || !set_option(socket_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kErrorClasses) ||
      !set_option(socket_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on) ||
      !set_option(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on) || !set_option(socket_, SOL_SOCKET, SO_RXQ_OVFL, on) ||
      !set_option(socket_, SOL_SOCKET, SO_TIMESTAMPNS, on) || !set_option(socket_, SOL_SOCKET, SO_RCVBUF, half)) {
    return failed_call("a CAN socket cannot be set up: setsockopt", errno, "a kernel of Linux 5.10 or newer is needed");
  }
  return std::nullopt;
}

std::optional<Failure> SocketCan::bind_to_interface() noexcept {
  const std::string& name = settings_.interface;
  const unsigned index = name.size() < IFNAMSIZ ? if_nametoindex(name.c_str()) : 0;
  if (index == 0) {
    return Failure{"no interface " + name, "see 'ip -brief link'; a virtual one: 'ip link add " + name +
                                               " type vcan && ip link set " + name + " up'"};
  }
  ifreq request{};
  std::memcpy(request.ifr_name, name.c_str(), name.size());
  if (ioctl(socket_, SIOCGIFHWADDR, &request) != 0 || request.ifr_hwaddr.sa_family != ARPHRD_CAN) {
    return Failure{name + " is not a CAN interface", "see 'ip -details link show type can', and type vcan"};
  }
  if (ioctl(socket_, SIOCGIFMTU, &request) != 0) {
    return failed_call(name + "does not report its MTU", errno, "see 'ip -details link show " + name + "'");
  }
  if (settings_.fd && request.ifr_mtu < static_cast<int>(CANFD_MTU)) {
    return Failure{name + " is not set up for CAN FD (MTU " + std::to_string(request.ifr_mtu) + ")",
                   "'ip link set " + name + " down; ip link set " + name +
                       " type can bitrate 1000000 dbitrate 5000000 fd on up', or for a vcan 'ip link set " + name +
                       " mtu 72'"};
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return failed_call("bind to " + name, errno, "see 'ip -details link show " + name + "'");
  }
  if (!interface_is_up()) {
    return Failure{name + " is down", "'ip link set " + name + " up'"};
  }
  return std::nullopt;
}

void SocketCan::receive(std::int64_t now_ns) noexcept {
  node_.begin_receive();
  for (mmsghdr& header : batch_->headers) {
    header.msg_hdr.msg_controllen = Batch::kControl;
  }
  const int count = recvmmsg(socket_, batch_->headers.data(), kMostWaiting, MSG_DONTWAIT, nullptr);
  realtime_offset_ns_ = hal::realtime_offset_ns();
  if (count < 0) {
    note_error(errno);
    return;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    take_message(i, now_ns);
  }
}

void SocketCan::take_message(std::size_t i, std::int64_t now_ns) noexcept {
  msghdr& header = batch_->headers[i].msg_hdr;
  std::int64_t arrived_ns = now_ns;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      // A clock that was set back gives a stamp of the future: the frame cannot be younger than now.
      arrived_ns = std::min(now_ns, nanoseconds(stamp) - realtime_offset_ns_);
    } else if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(part), sizeof dropped);
      node_.counters().dropped += dropped - dropped_before_;
      dropped_before_ = dropped;
    }
  }
  const canfd_frame& frame = batch_->frames[i];
  if ((frame.can_id & CAN_ERR_FLAG) != 0) {
    take_error_frame(frame.can_id & CAN_ERR_MASK, frame.data);
    return;
  }
  if ((header.msg_flags & MSG_CONFIRM) != 0) {
    node_.confirm(our_id(frame.can_id));
    return;
  }
  const unsigned size = batch_->headers[i].msg_len;
  if ((size != CAN_MTU && size != CANFD_MTU) || frame.len > (size == CAN_MTU ? CAN_MAX_DLEN : CANFD_MAX_DLEN)) {
    ++node_.counters().foreign;
    return;
  }
  CanFrame taken;
  taken.id = our_id(frame.can_id);
  taken.fd = size == CANFD_MTU;
  taken.bit_rate_switch = taken.fd && (frame.flags & CANFD_BRS) != 0;
  taken.length = frame.len;
  std::copy_n(frame.data, frame.len, taken.data.begin());
  node_.take(taken, arrived_ns);
}

void SocketCan::take_error_frame(std::uint32_t classes, const std::uint8_t* data) noexcept {
  ++node_.counters().error_frames;
  if ((classes & CAN_ERR_BUSOFF) != 0) {
    node_.change_state(CanState::bus_off);
  }
  if ((classes & CAN_ERR_CRTL) != 0) {
    if ((data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      node_.change_state(CanState::passive);
    } else if ((data[1] & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      node_.change_state(CanState::warning);
    } else if ((data[1] & CAN_ERR_CRTL_ACTIVE) != 0) {
      node_.change_state(CanState::good);
    }
  }
}

void SocketCan::note_error(int error) noexcept {
  if (is_interface_error(error)) {
    node_.change_state(CanState::down);
  }
}

CanSend SocketCan::try_send(const CanFrame& frame) noexcept {
  const CanSend may = node_.may_send(frame.id);
  if (may != CanSend::taken) {
    return may;
  }
  canfd_frame sent{};
  sent.can_id = kernel_id(frame.id);
  sent.len = frame.length;
  sent.flags = frame.bit_rate_switch ? CANFD_BRS : 0;
  std::copy_n(frame.data.begin(), frame.length, sent.data);
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  if (send(socket_, &sent, size, MSG_DONTWAIT) == static_cast<ssize_t>(size)) {
    node_.note_sent(frame.id);
    return CanSend::taken;
  }
  if (errno == ENOBUFS || errno == EAGAIN) {
    ++node_.counters().queue_full;
    return CanSend::queue_full;
  }
  note_error(errno);
  ++node_.counters().unusable;
  return CanSend::unusable;
}

bool SocketCan::interface_is_up() noexcept {
  ifreq request{};
  settings_.interface.copy(request.ifr_name, IFNAMSIZ - 1);
  return ioctl(socket_, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

bool SocketCan::may_take_interface_down() noexcept {
  ifreq request{};
  settings_.interface.copy(request.ifr_name, IFNAMSIZ - 1);
  return ioctl(socket_, SIOCGIFFLAGS, &request) == 0 && ioctl(socket_, SIOCSIFFLAGS, &request) == 0;
}

bool SocketCan::take_interface_down() noexcept {
  ifreq request{};
  settings_.interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(socket_, SIOCGIFFLAGS, &request) != 0) {
    return errno == ENODEV;
  }
  request.ifr_flags = static_cast<short>(request.ifr_flags & ~IFF_UP);
  return ioctl(socket_, SIOCSIFFLAGS, &request) == 0;
}

bool SocketCan::stop() noexcept {
  node_.stop();
  receive(read_clock(CLOCK_MONOTONIC));
  return !node_.anything_pending() || take_interface_down();
}

bool SocketCan::rearm() noexcept {
  // An interface that was taken away, and another of its name, have left the socket without binding and filters.
  if (!interface_is_up() || !set_filters() || bind_to_interface()) {
    return false;
  }
  // What came in while the bus was not in use, and the report of its going down, belong to the past.
  receive(read_clock(CLOCK_MONOTONIC));
  receive(read_clock(CLOCK_MONOTONIC));
  node_.rearm();
  return true;
}

}  // namespace hotfire::hal
