// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/files/record/record.hpp"

namespace hotfire {

/// A channel as a variable of MATLAB is named: "piston_pitch" of "piston.pitch".
std::string matlab_name(std::string channel);

/// Writes a record as a MATLAB file, version 5: a column for `time` and for every channel, and a struct `units` with the
/// unit of each.
void write_matlab(const Record& record, const std::filesystem::path& path);

}  // namespace hotfire
