// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hotfire {

/// `text` without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The parts of one line between delimiters, each trimmed; views of `line`. A line with n delimiters has n + 1 parts.
std::vector<std::string_view> parts_of(std::string_view line, char delimiter);

/// `text` without blanks, tabs and quotation marks at both ends.
std::string_view csv_trimmed(std::string_view text);

/// The parts of one line as cells, which may have quotation marks around them.
std::vector<std::string_view> csv_cells(std::string_view line, char delimiter);

/// The decimal number that is the whole of `cell`, with a point and an optional sign; empty if it is none.
std::optional<double> csv_number(std::string_view cell);

}  // namespace hotfire
