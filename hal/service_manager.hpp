// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hotfire::hal {

/// The connection to the service manager that has started this process, in the protocol of sd_notify(3): datagrams of text
/// to the socket that NOTIFY_SOCKET names. Without a manager, every call does nothing.
class ServiceManager {
 public:
  /// No service manager.
  ServiceManager() = default;
  /// `address`: a path, or "@name" for an abstract socket. `watchdog_us`: the manager ends a process that is silent for
  /// longer than this; 0: there is no watchdog.
  ServiceManager(std::string_view address, std::uint64_t watchdog_us);
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ServiceManager(ServiceManager&& other) noexcept;
  ServiceManager& operator=(ServiceManager&&) = delete;

  /// From NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  static ServiceManager from_environment();

  bool listens() const noexcept { return socket_ >= 0; }
  std::uint64_t watchdog_us() const noexcept { return watchdog_us_; }

  /// Sends lines like "READY=1". False if the manager did not take them. Does not wait for a reader, but is a system call.
  bool notify(std::string_view lines) const noexcept;

 private:
  int socket_ = -1;
  std::uint64_t watchdog_us_ = 0;
};

}  // namespace hotfire::hal
