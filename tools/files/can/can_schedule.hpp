// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/can/can_map.hpp"

namespace hotfire {

/// A frame that is sent with a period.
struct ScheduledFrame {
  std::string message;   ///< of the CAN map
  double period = 0.0;   ///< [s]
  double longest = 0.0;  ///< the longest it can take [s]
  double load() const { return longest / period; }
};

/// What a bus is to carry.
struct CanSchedule {
  std::filesystem::path path;
  double bit_rate = 0.0;       ///< [bit/s]
  double data_bit_rate = 0.0;  ///< of FD frames; 0: none are sent
  std::vector<ScheduledFrame> frames;

  /// Share of the bus taken in the worst case.
  double load() const;
};

/// Whether a TOML file is a schedule: it has a table [bus].
bool is_can_schedule(const std::filesystem::path& path);

/// Reads a schedule:
///
///     schema = 1
///     [bus]
///     bit_rate = 1e6            # bit/s
///     data_bit_rate = 5e6       # needed for FD frames
///     [frames]                  # message of the CAN map = period
///     SERVOVALVE_COMMAND = "1 ms"
///
/// Throws FileError with file, line, key and what is allowed; also for a schedule that takes more than hal::kLargestBusLoad
/// of its bus in the worst case, naming what takes most.
CanSchedule load_can_schedule(const std::filesystem::path& path, const CanMap& map = own_can_map());

}  // namespace hotfire
