#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/can_map.hpp"

namespace hotfire {

/// The greatest share of a bus that a schedule may take: the rest is for retransmission, and for what others send.
inline constexpr double kLargestBusLoad = 0.7;

/// The longest a frame can occupy a bus [s], with the worst stuff bits and the space to the next frame; `bytes` as on the
/// wire.
///
/// Classic, base format: 47 + 8 n bits and floor((33 + 8 n) / 4) stuff bits (Davis, Burns, Bril, Lukkien 2007).
/// FD, ISO 11898-1:2015, base format: at the arbitration rate 17 bits from start to the rate switch, at most 4 stuff bits of
/// theirs, and 13 from the check's delimiter to the space; at the data rate 5 + 8 n bits and the other stuff bits of the
/// floor((21 + 8 n) / 4) that start to data can have together, the stuff count of 4, a check of 17 (to 16 bytes) or 21 bits
/// and its 6 or 7 fixed stuff bits.
double longest_classic_frame(unsigned bytes, double bit_rate);
double longest_fd_frame(unsigned bytes, double bit_rate, double data_bit_rate);

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
/// Throws FileError with file, line, key and what is allowed; also for a schedule that takes more than kLargestBusLoad of
/// its bus in the worst case, naming what takes most.
CanSchedule load_can_schedule(const std::filesystem::path& path, const CanMap& map = own_can_map());

}  // namespace hotfire
