// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <string>

namespace hotfire::hal {

/// The reason why the machine refused a step of a set-up, and the remedy.
struct Failure {
  std::string what;
  std::string remedy;
};

/// A system call failed with `error`, a value of errno.
inline Failure failed_call(const std::string& call, int error, const std::string& remedy) {
  return {call + ": " + std::strerror(error), remedy};
}

}  // namespace hotfire::hal
