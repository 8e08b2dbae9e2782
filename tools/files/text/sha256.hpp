// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hotfire {

/// SHA-256 of a file's bytes in lower-case hexadecimal, as `sha256sum` prints it. Throws FileError if the file cannot be
/// read.
std::string sha256_of(const std::filesystem::path& path);

/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace hotfire
