// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/exchange/apart.hpp"
#include "tools/files/import/import.hpp"

namespace hotfire {

/// Reads the columns of `map` from a MATLAB file with matio, in this process. matio can crash on a damaged file:
/// `read_matlab_columns` calls this function in a process of its own.
/// @return the columns as bytes: of each its number of rows (uint64), then its values (double)
/// @throws FileError with file, column, channel and reason
std::string matlab_columns_text(const std::filesystem::path& path, const ImportMap& map);

/// A variable of a MATLAB file that is a column of a record.
struct MatlabVariable {
  std::string name;
  std::string unit;  ///< its field of the struct `units`; empty: none
};

/// Lists the variables of a MATLAB file that are numbers, in a process of its own. Throws FileError as
/// `read_matlab_columns`.
std::vector<MatlabVariable> read_matlab_variables(const std::filesystem::path& path);

/// Lists the variables of a MATLAB file that are numbers, in this process: name and unit of each on a line, with a tab
/// between them.
std::string matlab_variables_text(const std::filesystem::path& path);

}  // namespace hotfire
