// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/exchange/foreign_channels.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// Reads the datasets of an HDF5 file as channels under their names: those of the root, and those of each group, named by
/// its path ("a/b"), as a group of channels. An attribute `unit` or `units`, a text, is the unit; a dataset `time` is the
/// time. The library may crash on a damaged file: it reads in a process of its own.
///
/// A dataset that is not a vector of numbers, or has more rows than a record may have, has no values, and a `problem`.
/// Throws FileError with the file and the reason: not such a file, more than 10000 datasets.
std::vector<ForeignGroup> read_hdf5(const std::filesystem::path& path);

/// Writes a record as an HDF5 file: a dataset of doubles for `time` and for every channel, each with its unit.
void write_hdf5(const Record& record, const std::filesystem::path& path);

}  // namespace hotfire
