// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/exchange/foreign_channels.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// Reads the vectors of numbers in the root of an HDF5 file as the channels of one group, under the names of their datasets.
/// An attribute `unit`, a text, is the unit; the dataset `time` is the time. The library may crash on a damaged file: it
/// reads in a process of its own.
///
/// Throws FileError with the file, the dataset and the reason: not such a file, a dataset that is no vector of numbers or
/// has more rows than a record may have.
std::vector<ForeignGroup> read_hdf5(const std::filesystem::path& path);

/// Writes a record as an HDF5 file: a dataset of doubles for `time` and for every channel, each with its unit.
void write_hdf5(const Record& record, const std::filesystem::path& path);

}  // namespace hotfire
