// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/record/drop_out.hpp"

namespace hotfire {

/// One channel of a record, in SI (or the record's own unit for a `direct` model).
struct Channel {
  std::string name;  ///< "piston"
  std::string unit;  ///< SI unit after conversion, "m"
  std::vector<double> values;
};

/// The most rows a record may have.
inline constexpr std::size_t kMostRows = 10'000'000;

/// A uniformly sampled record.
struct Record {
  std::filesystem::path path;
  std::string name;     ///< file name without folder, "steps.csv"
  double start = 0.0;   ///< time of the first row [s]
  double period = 0.0;  ///< sampling period [s]
  std::size_t rows = 0;
  std::vector<Channel> channels;  ///< all but time, in file order
  std::size_t first_line = 0;     ///< of its file, where the first row is; 0: rows are not lines that follow each other

  /// The channel of that name, or null.
  const Channel* find(const std::string& channel) const;
  /// "steps.csv:7", or "steps.hfr: row 6" without lines, for messages about a row, which counts from 0.
  std::string place_of(std::size_t row) const;
};

/// The time of every row [s].
std::vector<double> times_of(const Record& record);

/// Reads and checks a CSV record (contract.md), or a recording of one actuator (recording.hpp). Throws FileError with file,
/// line, column, value and what is allowed: empty file, unknown channel or unit, ragged row, NaN or text, gap in time,
/// repeated or backward time, sampling outside 50 Hz - 20 kHz, more than 10^7 rows, a binary file (refused after its first
/// bytes, whatever its size).
///
/// Within `drop_outs` a row may have cells without a number, and rows may be missing (CSV only): their values are NaN, their
/// times are kept.
Record load_record(const std::filesystem::path& path, const std::vector<DropOut>& drop_outs = {});

/// Refuses a record whose position, velocity and acceleration of a mass are not in one unit of length and in seconds: each
/// is compared in the numbers that the record has. Throws FileError.
void require_units_of_one_motion(const Record& record);

/// Refuses a record in which two channels have different units: the model compares their numbers. A unit of 1 may be any.
/// Throws FileError.
void require_same_unit(const Record& record, const std::string& channel, const std::string& other);

/// Throws FileError unless the record has the channel; the message lists the channels it has and what the model needs.
void require_channel(const Record& record, const std::string& channel, const std::string& reason);

/// Writes a record as CSV: time[s], then every channel with its unit, each number with the fewest digits that restore it.
/// Writes to a temporary beside the target and renames it, so that a file is whole or absent.
void write_record(const Record& record, const std::filesystem::path& path);

}  // namespace hotfire
