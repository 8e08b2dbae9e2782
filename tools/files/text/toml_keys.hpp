// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace hotfire {

/// The most parts that a key of a TOML file may have, `a.b.c` has three. A parser makes a table of each, one within the
/// other, and takes stack for each: with the 256 tables and arrays that may be nested by brackets this stays
/// far below a megabyte.
inline constexpr std::size_t kMostKeyParts = 16;

/// What a parser of a TOML text must not be given.
struct KeyFault {
  enum class Kind {
    none,
    long_key,        ///< a key has more than `kMostKeyParts` parts
    foreign_letter,  ///< a letter beyond ASCII is outside of strings and comments, where TOML 1.0.0 has none
    escaped_letter,  ///< a letter beyond ASCII is behind a backslash, or first behind a line that ends with one
    quote_in_word    ///< a quote, a bracket or = is inside a word, where TOML 1.0.0 begins no string, table or array
  };
  Kind kind = Kind::none;
  std::size_t line = 0;  ///< from 1
};

/// The first of them. It reads strings and comments as TOML 1.0.0 has them, so that points in them are no parts and letters
/// in them are free. The parser's own table of letters has undefined behaviour on some that it should refuse.
KeyFault key_fault_of(std::string_view text);

}  // namespace hotfire
