// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hotfire {

/// Reads a line of a DBC file from left to right. What does not fit makes `good` false, and stays so: a statement is read to
/// its end and judged once. Takes time and memory in proportion to the line, and no stack.
class DbcLine {
 public:
  explicit DbcLine(std::string_view text) : rest_(text) {}

  bool good() const { return good_; }
  /// All of it was read, but for blanks.
  bool whole();

  /// Whether `text` comes next; takes it.
  bool maybe(std::string_view text);
  void expect(std::string_view text);
  /// At least one blank.
  void gap();
  /// Any number of blanks.
  void blanks();
  /// 1 to `most` decimal digits.
  std::string digits(std::size_t most);
  /// Letters, digits and underscores.
  std::string word();
  /// One of the letters, or 0.
  char one_of(std::string_view letters);
  /// Up to the next `end`, which is taken too.
  std::string up_to(char end);

 private:
  std::string take(std::size_t size);

  std::string_view rest_;
  bool good_ = true;
};

}  // namespace hotfire
