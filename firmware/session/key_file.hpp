// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "firmware/can/authentication.hpp"
#include "hal/failure.hpp"

namespace hotfire::firmware {

/// A key, or why there is none.
struct ReadKey {
  can::AuthenticationKey key{};
  std::optional<hal::Failure> refused;
};

/// Reads a file of 32 hexadecimal digits, that nobody but its owner may read. Before the loop.
ReadKey read_key(const std::string& path);

}  // namespace hotfire::firmware
