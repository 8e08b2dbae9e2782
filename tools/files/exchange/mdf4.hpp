// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/files/exchange/foreign_channels.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// Reads the channels of an MDF file, version 4: groups of channels of fixed length with integers of up to 64 bits and
/// floats of 32 and 64 bits, in either byte order, with the conversions 1:1, linear and rational; data blocks, lists of
/// them, and compressed ones; rows of several groups in one block, by their ids (unsorted). A value that its invalidation
/// bit takes back is NaN. A file that its program has not finalised is read up to its last whole row.
///
/// A channel of another type or with another conversion has no values, and a `problem`. Throws FileError with the file, the
/// place in it and the reason: not such a file, a block that does not lie in it, rows of a group that is not there.
std::vector<ForeignGroup> read_mdf4(const std::filesystem::path& path);

/// Writes a record as an MDF file, version 4.10: one group, its master channel `time` [s], every channel as doubles with its
/// unit.
void write_mdf4(const Record& record, const std::filesystem::path& path);

}  // namespace hotfire
