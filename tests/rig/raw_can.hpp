// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace hotfire::test {

inline void shell(const std::string& command) {
  if (std::system(command.c_str()) != 0) {
    FAIL(command.c_str());
  }
}

/// The other side of can0: a plain socket without a filter. `flags`: those of socket(2), such as SOCK_NONBLOCK.
class RawCan {
 public:
  explicit RawCan(int flags = 0) : file(socket(PF_CAN, SOCK_RAW | flags, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("can0"));
    CHECK_EQUAL(0, bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  }
  ~RawCan() { close(file); }
  RawCan(const RawCan&) = delete;
  RawCan& operator=(const RawCan&) = delete;

  const int file;
};

}  // namespace hotfire::test
