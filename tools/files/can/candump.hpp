// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/files/can/can_map.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire {

/// How a candump log is understood as a record, and a record written as one.
struct CandumpOptions {
  unsigned actuator = 1;             ///< 1 or 2 of the classic layout, 1 to 8 of the FD layout
  double command_per_current = 0.0;  ///< [rad/A]; 0: not known, the log then gives `current` and no `command`
};

/// Reads a log as `candump -l` and `candump -L` write it, `(1436509052.249713) can0 123#1122334455667788`, through the CAN
/// map.
///
/// A row is a reading of the actuator's potentiometer: `piston` [m], the mean of both readings; `current` [A] and with
/// `command_per_current` also `command` [rad]: what the plant was commanded until its next reading, which is the
/// newest command before that; `load_pressure` [Pa], which follows the reading with the same counter, and `string1` to
/// `string4` [m] of its engine, the newest before, if the log has them. Rows begin with the first reading that has all of
/// it. The time grid is that of the readings: their counter makes it gapless, their stamps give its period (to the
/// microsecond) and start; a stamp may be half a period off.
///
/// Frames that are not in the map, and error frames, are left out. Throws FileError with file and line for what is no line
/// of a log, a frame of the map with a wrong check, length or value, two interfaces, a lost reading, load pressure or
/// command, readings of both layouts, fewer than two rows.
Record load_candump(const std::filesystem::path& path, const CandumpOptions& options = {},
                    const CanMap& map = own_can_map());

/// Writes a record as such a log, in the classic layout, so that `load_candump` reads it back within a code of each signal.
/// It needs `piston`, and `current` or, with `command_per_current`, `command`; `load_pressure` goes along if it is
/// there, and `string1` to `string4` if all are. Throws FileError for a value beyond what its signal can carry.
void write_candump(const Record& record, const std::filesystem::path& path, const CandumpOptions& options = {},
                   const CanMap& map = own_can_map());

/// A record by its file's name: .log is a candump log, all else is read as CSV, whose values may be missing in `drop_outs`.
Record load_record_or_log(const std::filesystem::path& path, const CandumpOptions& options = {},
                          const std::vector<DropOut>& drop_outs = {});

}  // namespace hotfire
