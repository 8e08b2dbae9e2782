// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "tools/files/import/apart.hpp"
#include "tools/files/import/import.hpp"

namespace hotfire {

/// What the process that reads a MATLAB file may use: 4 GiB, since a column of as many rows as a record may have is 80 MB
/// and matio holds it twice; 60 s of processor, within 600 s on a machine that has a tenth of a processor for it.
constexpr ApartLimits matlab_limits(std::size_t result_bytes) { return {4096, 60, 600, result_bytes}; }

/// Reads the columns of `map` from a MATLAB file with matio, in this process. matio can crash on a damaged file:
/// `read_matlab_columns` calls this function in a process of its own.
/// @return the columns as bytes: of each its number of rows (uint64), then its values (double)
/// @throws FileError with file, column, channel and reason
std::string matlab_columns_text(const std::filesystem::path& path, const ImportMap& map);

}  // namespace hotfire
