// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/files/import/import.hpp"

namespace hotfire {

/// Reads the columns of `map` from a MATLAB file with matio, in this process. matio can crash on a damaged file:
/// `read_matlab_columns` calls this function in a process of its own.
/// @return the columns as bytes: of each its number of rows (uint64), then its values (double)
/// @throws FileError with file, column, channel and reason
std::string matlab_columns_text(const std::filesystem::path& path, const ImportMap& map);

}  // namespace hotfire
