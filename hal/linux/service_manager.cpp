// SPDX-License-Identifier: Apache-2.0
#include "hal/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace hotfire::hal {

ServiceManager::ServiceManager(std::string_view address, std::uint64_t watchdog_us) : watchdog_us_(watchdog_us) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (address.empty() || address.size() >= sizeof name.sun_path || (address[0] != '/' && address[0] != '@')) {
    return;
  }
  std::copy(address.begin(), address.end(), name.sun_path);
  if (address[0] == '@') {
    name.sun_path[0] = '\0';
  }
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size());
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ >= 0 && connect(socket_, reinterpret_cast<const sockaddr*>(&name), size) != 0) {
    close(std::exchange(socket_, -1));
  }
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) {
    close(socket_);
  }
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), watchdog_us_(other.watchdog_us_) {}

ServiceManager ServiceManager::from_environment() {
  const auto value = [](const char* name) {
    const char* const text = std::getenv(name);
    return std::string(text == nullptr ? "" : text);
  };
  const std::string pid = value("WATCHDOG_PID");
  const bool meant = pid.empty() || pid == std::to_string(getpid());
  return {value("NOTIFY_SOCKET"), meant ? std::strtoull(value("WATCHDOG_USEC").c_str(), nullptr, 10) : 0};
}

bool ServiceManager::notify(std::string_view lines) const noexcept {
  return socket_ >= 0 &&
         send(socket_, lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(lines.size());
}

}  // namespace hotfire::hal
