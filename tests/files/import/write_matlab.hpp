// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hotfire::test {

/// A matrix, column by column.
struct MatlabMatrix {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;
};

/// A struct of one field, a column vector.
struct MatlabStruct {
  std::string name;
  std::string field;
  std::vector<double> values;
};

/// How a file is written: `save -v4`, `-v6`, `-v7`, `-v7.3`.
enum class MatlabVersion { v4, v6, v7, v7_3 };

/// Writes a column vector of a MATLAB class, "int8" to "uint64", "single", "double", "logical" or "char", into a file of its
/// own; `values` are of the C++ type that holds this class. False if the library of this machine cannot write that version
/// (7.3 is HDF5, without which it can be built; it does not write every class as MATLAB 4).
bool write_matlab_class(const std::filesystem::path& path, MatlabVersion version, const std::string& name,
                        const std::string& matlab_class, const void* values, std::size_t rows);

/// Writes a MATLAB 5 file.
void write_matlab(const std::filesystem::path& path, const std::vector<MatlabMatrix>& matrices,
                  const MatlabStruct& with_field);

}  // namespace hotfire::test
