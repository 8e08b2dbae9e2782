// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include <CppUTest/TestHarness.h>

namespace hotfire::test {

/// Checks that a message holds every part: file and line, key or column, value, what is allowed.
inline void expect_message(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts) {
    STRCMP_CONTAINS(part, message.c_str());
  }
}

}  // namespace hotfire::test
