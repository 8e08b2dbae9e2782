// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/files/record/record.hpp"

namespace hotfire {

/// Which part of a recording a record is made of.
struct RecordingPart {
  unsigned actuator = 0;   ///< from 1; 0: the only one, or all axes of a vehicle
  std::uint64_t from = 0;  ///< cycle to begin with
  bool up_to_gap = false;  ///< end before the first cycle that was dropped; else a recording with one is refused
};

/// True if the file begins like a recording of `hotfire plant --record`.
bool is_recording(const std::filesystem::path& path);

/// A recording (docs/recording.md) as a record: time, the input and every channel of one actuator that a record can have, on
/// the plant's own time:
/// cycle n begins at (n + 1) periods, and its row has the command held from there on and what the sensors read there, which
/// is what the cycle before had sent. The first row, at time 0, is the plant at rest at zero before its first cycle.
///
/// Of a vehicle (topology taos or masv) the record is of all its axes, `command.pitch`, `piston.pitch` ... as `simulate`
/// takes them, unless one actuator is named, and begins with the first cycle: cycle n begins at n periods.
///
/// Throws FileError for a file that is refused or damaged, an actuator it does not have or that must be named, cycles that
/// were dropped, and fewer than two rows, with the remedy.
Record load_recording(const std::filesystem::path& path, const RecordingPart& part = {});

}  // namespace hotfire
