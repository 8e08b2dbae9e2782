// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire::firmware {

/// printf into a string. Outside the loop only.
__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...);

}  // namespace hotfire::firmware
