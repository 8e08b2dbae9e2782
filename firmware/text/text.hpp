// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace hotfire::firmware {

/// printf into a string. Outside the loop only.
__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...);

/// A count as the formats above take it: %llu, whatever 64 bits are on the target.
constexpr unsigned long long whole(std::uint64_t count) noexcept { return count; }

}  // namespace hotfire::firmware
