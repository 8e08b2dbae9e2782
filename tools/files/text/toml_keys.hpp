#pragma once

#include <cstddef>
#include <string_view>

namespace hotfire {

/// The most parts that a key of a TOML file may have, `a.b.c` has three. A parser makes a table of each, one within the
/// other, and takes stack for each: with the 256 tables and arrays that may stand within each other by brackets this stays
/// far below a megabyte.
inline constexpr std::size_t kMostKeyParts = 16;

/// The line, from 1, of the first key of a TOML text that has more than `kMostKeyParts` parts; 0: there is none. It reads
/// strings and comments as TOML 1.0.0 has them, so that points in them are no parts.
std::size_t line_of_long_key(std::string_view text);

}  // namespace hotfire
