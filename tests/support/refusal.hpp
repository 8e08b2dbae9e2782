// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/files/text/error.hpp"

namespace hotfire::test {

/// The message of the `Error` that `action` throws; empty if it throws none.
template <class Error = FileError, class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace hotfire::test
