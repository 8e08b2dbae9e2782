// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "hal/recording/format.hpp"

namespace hotfire::hal {

/// One cycle of a recording. The spans are valid until the next one is read.
struct RecordedCycle {
  CycleHead head;
  std::uint64_t dropped_before = 0;  ///< cycles that ran between the one before and this and are not in the file
  std::uint64_t skipped_before = 0;  ///< cycles that were due there and were not run
  std::span<const double> commands;  ///< one an actuator
  std::span<const double> readings;  ///< actuator after actuator
};

/// Reads a recording from its beginning to its last complete block, one block at a time. A file whose writer was killed, or
/// that is still being written, is read in the same way: only its end is missing, and `end()` reports it.
class RecordingReader {
 public:
  /// The end of a recording. `cut_off`: its writer did not close it. `damaged`: a block within the file has changed; the
  /// blocks after it are not read.
  enum class End { closed, cut_off, damaged };

  /// Opens the file and reads its header. `error()` is then empty, or gives the reason of a refusal.
  explicit RecordingReader(const std::string& path);

  const std::string& error() const { return error_; }
  const RecordingHeader& header() const { return header_; }

  /// The next cycle; false at the end.
  bool next(RecordedCycle& cycle);

  /// After `next` has returned false.
  End end() const { return end_; }
  std::uint64_t cycles() const { return cycles_; }
  /// Cycles that ran and are not in the file, including those after its last one if it was closed.
  std::uint64_t dropped() const { return end_ == End::closed ? dropped_at_end_ : dropped_; }

 private:
  bool read_block();
  bool no_more(End end);

  std::ifstream file_;
  RecordingHeader header_;
  std::string error_;
  std::vector<std::byte> block_;
  std::size_t cycle_bytes_ = 0;
  std::size_t next_in_block_ = 0;
  std::size_t in_block_ = 0;
  std::vector<double> values_;
  std::uint64_t expected_ = 0;
  std::uint64_t cycles_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t dropped_at_end_ = 0;
  End end_ = End::cut_off;
};

}  // namespace hotfire::hal
