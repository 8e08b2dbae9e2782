// SPDX-License-Identifier: Apache-2.0
#include "firmware/text/text.hpp"

#include <cstdarg>
#include <cstdio>

namespace hotfire::firmware {

std::string text(const char* format, ...) {
  std::va_list arguments;
  std::va_list again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string result(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, arguments)), '\0');
  std::vsnprintf(result.data(), result.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return result;
}

}  // namespace hotfire::firmware
