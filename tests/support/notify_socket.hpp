// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace hotfire::test {

/// A service manager's end of a notify socket: a real datagram socket, at a path or, as "@name", in the abstract space.
class NotifySocket {
 public:
  explicit NotifySocket(std::string address) : address_(std::move(address)), socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::copy(address_.begin(), address_.end(), name.sun_path);
    if (address_[0] == '@') {
      name.sun_path[0] = '\0';
    }
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
    bound_ = bind(socket_, reinterpret_cast<const sockaddr*>(&name), size) == 0;
  }
  ~NotifySocket() {
    close(socket_);
    if (address_[0] != '@') {
      unlink(address_.c_str());
    }
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  const std::string& address() const { return address_; }
  bool bound() const { return bound_; }

  /// The next datagram; empty if none comes in that time.
  std::string next(int milliseconds) const {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, milliseconds) != 1) {
      return "";
    }
    std::array<char, 1024> text{};
    const ssize_t size = recv(socket_, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
  }

 private:
  std::string address_;
  int socket_;
  bool bound_ = false;
};

}  // namespace hotfire::test
