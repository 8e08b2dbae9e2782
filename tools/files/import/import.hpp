// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/can/dbc.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// What somebody else's file is.
enum class ImportSource { table, candump_log };

/// A candump log if there is a DBC file (path not empty) that says what its frames carry, else a table. Throws UsageError
/// for a candump log without one.
ImportSource import_source(const std::filesystem::path& source, const std::filesystem::path& dbc);

/// Where a channel of a record is in somebody else's file.
struct ImportColumn {
  std::string channel;   ///< "command"; "time"
  std::string column;    ///< header of a CSV column; variable of a MATLAB file, "data.beta" in a struct, "X:3" in a matrix;
                         ///< signal of a DBC file, "beta", "FEEDBACK.beta"
  std::string unit;      ///< of column times factor; empty: that of the DBC file
  double factor = 1.0;   ///< -1 turns a sign
  double offset = 0.0;   ///< added to column times factor [unit]
  std::size_t line = 0;  ///< of the map
};

/// How somebody else's file is read (contract.md, Import maps).
struct ImportMap {
  std::filesystem::path path;
  std::vector<ImportColumn> columns;  ///< of a table time first, unless `period` replaces it
  double period = 0.0;                ///< of the source [s]; 0: there is a time column
  double resampling_period = 0.0;     ///< of the record [s]; 0: that of the source, which has to be even
  char delimiter = ',';
  std::size_t skip_lines = 0;  ///< before the header of a CSV file
  std::string events;          ///< last column of the header, of which a row may have none or several; empty: there is none
  std::string rows;            ///< message of a DBC file whose frames make the rows; empty: the only one there is
};

/// Reads and checks a map. Throws FileError with file, line, key, value and what is allowed.
ImportMap load_import_map(const std::filesystem::path& path, ImportSource source = ImportSource::table);

/// The columns of the map, in its order, from a CSV file with a header; an empty cell is NaN. Throws FileError with file,
/// line and column: no such column (with those that there are), ragged row, text that is not a number. Cells from the column
/// `events` on are words that say what happened, in as many cells as there is to say.
std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path, const ImportMap& map);

/// The same from a MATLAB file (version 4 to 7.2; 7.3 where the library has HDF5). Throws FileError: not such a file, no
/// such variable (with those that there are), not a real vector or matrix column of numbers or logicals, an integer beyond
/// 2^53, which no double holds; a file on which the library crashes or takes over 60 s or 4 GiB: it is read in a process of
/// its own.
std::vector<std::vector<double>> read_matlab_columns(const std::filesystem::path& path, const ImportMap& map);

/// Columns with a time and with units.
struct ImportedColumns {
  std::vector<ImportColumn> columns;
  std::vector<std::vector<double>> values;
};

/// The same from a candump log, whose frames are what the DBC file says.
///
/// A row is a frame of the map's message `rows`. It has of each measured channel the newest value up to that frame; of
/// `command`, `current` and `force`, which hold until the next row, the newest before the next row: what the plant was
/// commanded for that time. Rows begin with the first that has all of it. Times are `stamped_grid` of those frames.
///
/// Throws FileError with map and line for a signal that the DBC file does not have (with the nearest names) or has more than
/// once, a unit that contradicts it, signals of several messages without `rows`; with log and line for what is no line of a
/// log, a frame of another length than its message's, a value beyond its signal's range, two interfaces, lost frames of
/// `rows`, a message silent for over two and a half of its cycle times; for a signal that never occurs, fewer than two rows.
ImportedColumns read_candump_columns(const std::filesystem::path& path, const Dbc& dbc, const ImportMap& map);

/// Reads `source` (with a DBC file a candump log, else .mat, .mf4, .h5 or CSV) through the map and writes a record, which is
/// then read as `load_record` reads any other: nothing is repaired. Throws FileError, and leaves no file behind, where that
/// refuses it. Within `drop_outs` [s] cells of a CSV file may be empty, values NaN and rows missing: they stay so in the
/// record. `notes` takes in what was done to the values beside units, one sentence each.
Record import_record(const std::filesystem::path& source, const ImportMap& map, const std::filesystem::path& output,
                     const std::filesystem::path& dbc = {}, const std::vector<DropOut>& drop_outs = {},
                     std::vector<std::string>* notes = nullptr);

/// The record of columns that have been read through a map, the time first unless it has a period: written to `output` and
/// read from it, as `import_record` does.
Record record_of_columns(const std::filesystem::path& source, const ImportMap& map,
                         const std::vector<std::vector<double>>& values, const std::filesystem::path& output);

}  // namespace hotfire
