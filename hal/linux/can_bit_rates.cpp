// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can_bit_rates.hpp"

#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace hotfire::hal {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// The content of the attribute of a type among those that `bytes` begin with; empty if it is not there.
Bytes attribute(Bytes bytes, unsigned type) noexcept {
  while (bytes.size() >= sizeof(rtattr)) {
    rtattr head{};
    std::memcpy(&head, bytes.data(), sizeof head);
    if (head.rta_len < sizeof head || head.rta_len > bytes.size()) {
      return {};
    }
    if ((head.rta_type & NLA_TYPE_MASK) == type) {
      return bytes.subspan(RTA_LENGTH(0), head.rta_len - RTA_LENGTH(0));
    }
    bytes = bytes.subspan(std::min<std::size_t>(RTA_ALIGN(head.rta_len), bytes.size()));
  }
  return {};
}

double bit_rate_in(Bytes timing) noexcept {
  can_bittiming read{};
  if (timing.size() < sizeof read) {
    return 0.0;
  }
  std::memcpy(&read, timing.data(), sizeof read);
  return read.bitrate;
}

/// Sends a request for one link and takes the answer's attributes in.
Bytes ask(int socket, unsigned index, std::span<std::uint8_t> buffer) noexcept {
  struct {
    nlmsghdr head;
    ifinfomsg link;
  } request{};
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.link.ifi_index = static_cast<int>(index);
  if (send(socket, &request, sizeof request, 0) != static_cast<ssize_t>(sizeof request)) {
    return {};
  }
  const ssize_t size = recv(socket, buffer.data(), buffer.size(), 0);
  constexpr std::size_t kBefore = NLMSG_LENGTH(NLMSG_ALIGN(sizeof(ifinfomsg)));
  if (size < static_cast<ssize_t>(kBefore)) {
    return {};
  }
  nlmsghdr head{};
  std::memcpy(&head, buffer.data(), sizeof head);
  return head.nlmsg_type == RTM_NEWLINK ? Bytes(buffer).subspan(kBefore, static_cast<std::size_t>(size) - kBefore) : Bytes{};
}

/// What the kernel says of a link of this name, in `buffer`; empty if nothing.
Bytes link_info(const std::string& interface, std::span<std::uint8_t> buffer) noexcept {
  const unsigned index = if_nametoindex(interface.c_str());
  const int socket = index == 0 ? -1 : ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (socket < 0) {
    return {};
  }
  const Bytes info = attribute(ask(socket, index, buffer), IFLA_LINKINFO);
  close(socket);
  return info;
}

}  // namespace

CanBitRates can_bit_rates(const std::string& interface) noexcept {
  std::array<std::uint8_t, 16384> buffer{};
  const Bytes can = attribute(link_info(interface, buffer), IFLA_INFO_DATA);
  return {bit_rate_in(attribute(can, IFLA_CAN_BITTIMING)), bit_rate_in(attribute(can, IFLA_CAN_DATA_BITTIMING))};
}

bool is_virtual_can(const std::string& interface) noexcept {
  std::array<std::uint8_t, 16384> buffer{};
  const Bytes kind = attribute(link_info(interface, buffer), IFLA_INFO_KIND);
  const auto is = [&](std::string_view name) {
    // A string of the kernel, with its zero.
    return kind.size() == name.size() + 1 && std::equal(name.begin(), name.end(), kind.begin());
  };
  return is("vcan") || is("vxcan");
}

}  // namespace hotfire::hal
