// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// What the bits of a signal mean.
enum class DbcNumber { unsigned_integer, signed_integer, single_precision, double_precision };

/// A number in a CAN frame: `physical = offset + factor raw`.
struct DbcSignal {
  std::string name;
  std::size_t line = 0;     ///< of the DBC file
  unsigned start = 0;       ///< bit 8 i + j is bit j of byte i: the lowest one, or the highest of a big-endian signal
  unsigned length = 0;      ///< bits, up to 64
  bool big_endian = false;  ///< Motorola
  DbcNumber number = DbcNumber::unsigned_integer;
  double factor = 1.0;
  double offset = 0.0;
  double lowest = 0.0;  ///< physical range; both ends the same: none is declared
  double highest = 0.0;
  std::string unit;
  bool is_multiplexer = false;
  std::optional<std::uint64_t> selected_by;  ///< what the multiplexer of a frame that carries this is; none: all carry it

  std::uint64_t raw(std::span<const std::uint8_t> data) const;
  double physical(std::span<const std::uint8_t> data) const;
  /// Whether a physical value is finite and, to half a code, within the range.
  bool allows(double physical) const;
};

struct DbcMessage {
  std::string name;
  std::size_t line = 0;  ///< of the DBC file
  std::string sender;
  std::uint32_t id = 0;                    ///< 11 bits, or 29 bits with kExtendedId
  unsigned length = 0;                     ///< bytes
  unsigned cycle_ms = 0;                   ///< GenMsgCycleTime; 0: not cyclic
  unsigned data_id = 0;                    ///< E2EDataId; 0: none
  int frame_format = 0;                    ///< VFrameFormat
  bool has_extended_multiplexing = false;  ///< a multiplexer that is multiplexed, or ranges of its values
  std::vector<DbcSignal> signals;

  const DbcSignal* find(std::string_view signal) const;
  /// The signal that says which of the multiplexed ones a frame carries, or null.
  const DbcSignal* multiplexer() const;
};

/// What a DBC file says frames look like.
struct Dbc {
  std::filesystem::path path;
  std::vector<DbcMessage> messages;

  const DbcMessage* find(std::string_view message) const;
};

/// Set in the id of a frame of 29 bits, by DBC files as by SocketCAN.
inline constexpr std::uint32_t kExtendedId = 0x80000000;

/// Reads a DBC file: messages, signals (either byte order, floating-point, multiplexed), cycle times, frame formats; what
/// else there is (comments, units of other tools) is left out. Throws FileError with file and line for what is wrong: a
/// signal beyond its frame, a message or signal twice, a factor of 0, a text without end, no message at all; over 16 MiB, a
/// line over 64 KiB, over 10,000 messages or 1024 signals of one, so that any input is read in bounded time and memory.
Dbc read_dbc(std::string_view text, const std::filesystem::path& path);

/// The same of a file. Throws FileError if it cannot be read.
Dbc load_dbc(const std::filesystem::path& path);

}  // namespace hotfire
