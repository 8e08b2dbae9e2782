// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace hotfire {

/// The exit statuses of every command (contract.md).
enum class ExitStatus { good = 0, bad_verdict = 1, wrong_use = 2, hardware = 3, timing = 4, interlock = 5, bad_data = 6 };

/// A file that is refused: what() names file, line, key or column, value and what is allowed.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A command used wrongly: what() says what and the remedy.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hotfire
