// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/exchange/foreign_channels.hpp"
#include "tools/files/import/import.hpp"

namespace hotfire {

/// The file name extensions of other programs' formats that can hold a record: MDF 4, HDF5 and MATLAB.
std::vector<std::string> foreign_extensions();

/// True for a file name with one of them.
bool is_foreign(const std::filesystem::path& path);

/// Reads a record from a file in such a format whose channels have the names of a record and known units. Those of a MATLAB
/// file are named with an underscore before the axis (`piston_pitch`). Everything that `load_record` checks is checked.
///
/// Throws FileError: what the reader of the format refuses, no time, a channel that a record cannot have, several groups
/// with channels. A file with other names is for `hotfire import`, which the message says.
Record load_foreign(const std::filesystem::path& path);

/// The channels of a file in such a format, by groups; the numeric variables of a MATLAB file are one group. Throws
/// FileError as the reader of the format does.
std::vector<ForeignGroup> foreign_groups(const std::filesystem::path& path);

/// Writes a record in the format of the file name's extension.
void write_foreign(const Record& record, const std::filesystem::path& path);

/// The columns of a map from a file in such a format. Of MDF and HDF5 a channel by its name, or `GROUP/CHANNEL` where
/// several groups have one of that name. Throws FileError: no such channel (with the nearest), several, channels of groups
/// that were sampled apart.
std::vector<std::vector<double>> read_foreign_columns(const std::filesystem::path& path, const ImportMap& map);

}  // namespace hotfire
