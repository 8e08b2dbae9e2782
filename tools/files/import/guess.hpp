// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace hotfire {

/// A map that may read `source`, a text log with a header or an MDF, HDF5 or MATLAB file, as TOML with comments for its user
/// to check: delimiter, lines before the header, a column of events, time (a column that rises evenly, or the sampling
/// interval or rate that the lines before the header say), and the channels that names and units in brackets give away.
/// Columns whose names say nothing are comments with their range. Of a file with groups of channels, the map is that of the
/// group with the most, and a comment names every other channel. Throws FileError for a file in which no header is above
/// rows of numbers, or that its reader refuses.
std::string guessed_map(const std::filesystem::path& source);

}  // namespace hotfire
