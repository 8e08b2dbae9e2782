// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hal/recording/reader.hpp"

namespace hotfire::firmware {

/// What a replay found: the recorded inputs, fed to the recorded model, or to a lab's logic with the recorded profile, from
/// the start, offline.
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

/// Says that a recorded value is not the replayed one, bit for bit; empty if it is. Actuators count from 0.
std::string differing(const hal::RecordedChannel& channel, std::size_t actuator, double recorded, double replayed);

/// Goes through a recording up to what was dropped or differs. `difference_in` replays a cycle and says what of it is not as
/// recorded; empty if all is.
void replay_cycles(hal::RecordingReader& reader, Replay& result,
                   const std::function<std::string(const hal::RecordedCycle&)>& difference_in);

/// Replays a recording from a fresh reader.
Replay replay(hal::RecordingReader& reader);

/// Replays a file and prints what it found. Returns the exit status: 0 every recorded cycle has the same bits; 1 one
/// differs, or lies behind a gap and cannot be proved; 6 the file is refused or damaged.
int run_replay(const std::string& path, bool json);

}  // namespace hotfire::firmware
