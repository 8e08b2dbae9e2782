// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hotfire {

/// `text` without blanks, tabs and quotation marks at both ends.
std::string_view csv_trimmed(std::string_view text);

/// The cells of one line, each trimmed; views of `line`. A line with n delimiters has n + 1 cells.
std::vector<std::string_view> csv_cells(std::string_view line, char delimiter);

/// The decimal number that is the whole of `cell`, with a point and an optional sign; empty if it is none.
std::optional<double> csv_number(std::string_view cell);

}  // namespace hotfire
