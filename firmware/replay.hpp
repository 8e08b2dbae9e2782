#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/recording/reader.hpp"

namespace hotfire::firmware {

/// What a replay found: the recorded commands, fed to the recorded model from its start, offline.
struct Replay {
  /// The first cycle whose state or readings are not the bits that were recorded.
  struct Difference {
    std::uint64_t cycle = 0;
    std::string what;  ///< which reading, or the state behind the same readings
  };

  std::uint64_t recorded = 0;          ///< cycles in the file
  std::uint64_t dropped = 0;           ///< cycles that ran and are not in the file
  std::uint64_t proved = 0;            ///< cycles replayed with the same bits
  std::optional<std::uint64_t> gap{};  ///< first cycle that was dropped before a recorded one: no replay goes beyond it
  std::optional<Difference> difference{};
  hal::RecordingReader::End end = hal::RecordingReader::End::cut_off;
  std::string error{};  ///< the recording cannot be replayed at all
};

/// Replays a recording from a fresh reader.
Replay replay(hal::RecordingReader& reader);

/// Replays a file and prints what it found. Returns the exit status: 0 every recorded cycle has the same bits; 1 one
/// differs, or lies behind a gap and cannot be proved; 6 the file is refused or damaged.
int run_replay(const std::string& path, bool json);

}  // namespace hotfire::firmware
