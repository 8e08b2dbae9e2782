// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hotfire::doctor {

/// The text of a file of /sys or /proc without the white space at its end; none if it cannot be read.
std::optional<std::string> text_of(const std::filesystem::path& path);

/// Whether a list like "1-3,7" of /sys has the number.
bool list_has(const std::string& list, int number);

/// What is in a folder, by name, in order; empty if it cannot be read.
std::vector<std::string> names_in(const std::filesystem::path& folder);

}  // namespace hotfire::doctor
