// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tools/files/model/model_layout.hpp"

namespace hotfire {

/// The fewest digits that restore a number. TOML reads digits alone as an integer, which has no -0 and no 1e300.
std::string number_text(double value);

/// A string in quotes, with what TOML wants escaped.
std::string toml_string(std::string_view text);

/// "key = value", then unit and meaning as a comment.
void append_line(std::string& text, const std::string& key_and_value, std::string_view unit, std::string_view meaning);

/// Every line of a group that acts: its choice, its numbers and its curves.
void append_group(std::string& text, const KeyGroup& group);

}  // namespace hotfire
