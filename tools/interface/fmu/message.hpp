// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace hotfire::fmu {

/// A message as an importer reads it. Both standards give '#' a meaning, a reference to a variable, and version 2.0 takes a
/// message as a format of printf: such a character is doubled. A long message is cut.
class Message {
 public:
  Message(std::string_view text, std::string_view doubled) noexcept {
    std::size_t at = 0;
    for (const char letter : text) {
      const bool twice = doubled.find(letter) != std::string_view::npos;
      if (at + (twice ? 2 : 1) >= text_.size()) {
        break;
      }
      text_[at++] = letter;
      if (twice) {
        text_[at++] = letter;
      }
    }
  }

  const char* c_str() const noexcept { return text_.data(); }

 private:
  std::array<char, 1024> text_{};
};

}  // namespace hotfire::fmu
