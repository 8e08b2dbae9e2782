// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/recording/fnv1a.hpp"

namespace hotfire::hal {

/// A recording of a plant's cycles (docs/recording.md): a text header, then blocks of cycles. Every number is little-endian.
static_assert(std::endian::native == std::endian::little, "cycles are written as they are in memory");

/// The head of every cycle. Commands and readings follow: one double for each actuator, then one double for each sensor.
struct CycleHead {
  /// No new command had arrived: the previous one was held.
  static constexpr std::uint64_t kHeld = 1;
  /// The cycle began at its release; otherwise it was already due at the end of the previous cycle.
  static constexpr std::uint64_t kSlept = 2;
  /// The bus did not take the reading.
  static constexpr std::uint64_t kLost = 4;
  /// It is counted apart.
  static constexpr std::uint64_t kWarmUp = 8;
  /// Of a lab: the state of its interlock and the number of the first fault since it was armed, 8 bits each; then its
  /// boolean inputs.
  static constexpr unsigned kStateShift = 8;
  static constexpr unsigned kFaultShift = 16;
  static constexpr unsigned kInputsShift = 24;
  /// Number of overdue cycles that the loop skipped before this one, at most kMostSkipped.
  static constexpr unsigned kSkippedShift = 48;
  static constexpr std::uint64_t kMostSkipped = 0xffff;
  static constexpr std::uint64_t lab_flags(std::uint64_t state, std::uint64_t fault) noexcept {
    return state << kStateShift | fault << kFaultShift;
  }
  constexpr std::uint64_t skipped_before() const noexcept { return flags >> kSkippedShift; }

  std::uint64_t cycle = 0;      ///< from 0; a gap is what was dropped, or what the loop left out
  std::int64_t release_ns = 0;  ///< CLOCK_MONOTONIC, as the moments that follow
  std::int64_t woken_ns = 0;
  std::int64_t read_ns = 0;
  std::int64_t stepped_ns = 0;
  std::int64_t written_ns = 0;
  std::uint64_t command_sequence = 0;  ///< the sender's count of the command in use; of a lab its last one's age [ns]
  std::uint64_t hash = 0;              ///< FNV-1a over state and readings of every cycle up to this one
  std::uint64_t flags = 0;
};
static_assert(sizeof(CycleHead) == 72);

/// Values of one actuator that a recording has room for, beside its command.
inline constexpr std::size_t kMostRecordedChannels = 9;

constexpr std::size_t cycle_bytes(std::size_t actuators, std::size_t readings) noexcept {
  return sizeof(CycleHead) + sizeof(double) * (actuators + readings);
}

/// The head of every block.
struct BlockHead {
  enum Kind : std::uint32_t { kCycles = 0, kEnd = 1 };
  static constexpr std::uint64_t kMagic = 0x314b434f4c424648;  // the bytes "HFBLOCK1"

  std::uint64_t magic = kMagic;
  std::uint32_t kind = kCycles;
  std::uint32_t cycles = 0;    ///< that follow
  std::uint64_t dropped = 0;   ///< of an end: cycles that are not in the recording; else 0
  std::uint64_t checksum = 0;  ///< FNV-1a over the three fields before it and over the cycles

  std::uint64_t checksum_with(std::span<const std::byte> content) const noexcept {
    Fnv1a hash;
    hash.add((static_cast<std::uint64_t>(kind) << 32) | cycles);
    hash.add(dropped);
    hash.add(content);
    return hash.value();
  }
};
static_assert(sizeof(BlockHead) == 32);

/// No writer makes a block of more cycles. A reader therefore needs no more memory than this.
inline constexpr std::uint32_t kMostCyclesOfBlock = 4096;

/// A channel with its unit, SI; "1" for one without.
struct RecordedChannel {
  std::string name;
  std::string unit;
};

/// The origin of a recording and the meaning of its numbers.
struct RecordingHeader {
  std::string version;  ///< of the program that wrote it
  std::string started;  ///< ISO 8601, UTC
  std::string host;
  std::string kernel;
  std::string command_line;
  std::string topology;
  std::int64_t period_ns = 0;
  unsigned steps_per_cycle = 0;
  unsigned actuators = 0;
  RecordedChannel input;                  ///< of every actuator
  std::vector<RecordedChannel> channels;  ///< of every actuator
  std::vector<double> start;              ///< readings before the first cycle, actuator after actuator
  std::string model;                      ///< plant image: every parameter, bit for bit
};

/// Identifies a model: FNV-1a over its plant image.
std::uint64_t model_hash(std::string_view model);

/// The header at the beginning of a file.
std::string header_text(const RecordingHeader& header);

/// The first line of every recording; the number is the version of the format.
inline constexpr std::string_view kRecordingMark = "hotfire recording 2\n";

}  // namespace hotfire::hal
