// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <string>

namespace hotfire::hal {

/// Why a step of a set-up was refused by the machine, and what a person does about it.
struct Failure {
  std::string what;
  std::string remedy;
};

/// That a call of the system failed with `error`, a value of errno.
inline Failure failed_call(const std::string& call, int error, const std::string& remedy) {
  return {call + ": " + std::strerror(error), remedy};
}

}  // namespace hotfire::hal
