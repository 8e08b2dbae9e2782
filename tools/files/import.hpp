#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/record.hpp"

namespace hotfire {

/// Where a channel of a record is in somebody else's file.
struct ImportColumn {
  std::string channel;  ///< "command"; "time"
  std::string column;   ///< header of a CSV column; variable of a MATLAB file, "data.beta" in a struct, "X:3" in a matrix
  std::string unit;     ///< of column times factor
  double factor = 1.0;  ///< -1 turns a sign
};

/// How somebody else's file is read (contract.md, Import maps).
struct ImportMap {
  std::filesystem::path path;
  std::vector<ImportColumn> columns;  ///< time first, unless `period` stands for it
  double period = 0.0;                ///< [s]; 0: there is a time column
  char delimiter = ',';
  std::size_t skip_lines = 0;  ///< before the header of a CSV file
};

/// Reads and checks a map. Throws FileError with file, line, key, value and what is allowed.
ImportMap load_import_map(const std::filesystem::path& path);

/// The columns of the map, in its order, from a CSV file with a header. Throws FileError with file, line and column: no such
/// column (with those that there are), ragged row, text that is not a number.
std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path, const ImportMap& map);

/// The same from a MATLAB file (version 4 to 7.2; 7.3 where the library has HDF5). Throws FileError: not such a file, no
/// such variable (with those that there are), not a real vector or matrix column of numbers or logicals, an integer beyond
/// 2^53, which no double holds.
std::vector<std::vector<double>> read_matlab_columns(const std::filesystem::path& path, const ImportMap& map);

/// Reads `source` (.mat, else CSV) through the map and writes a record, which is then read as `load_record` reads any other:
/// nothing is repaired. Throws FileError, and leaves no file behind, where that refuses it.
Record import_record(const std::filesystem::path& source, const ImportMap& map, const std::filesystem::path& output);

}  // namespace hotfire
