// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hal/recording/reader.hpp"

namespace hotfire::firmware {

/// Result of a replay: the recorded inputs run through the recorded model, or through a lab's logic with the recorded
/// profile, from the start, offline.
struct Replay {
  /// The first cycle whose state or readings differ from the recorded bits.
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

/// The difference between a recorded value and the replayed one, bit for bit; empty if they are equal. Actuators count from
/// 0.
std::string differing(const hal::RecordedChannel& channel, std::size_t actuator, double recorded, double replayed);

/// Replays a recording up to a dropped cycle or a difference. `difference_in` replays a cycle and returns its difference
/// from the recording; empty if there is none.
void replay_cycles(hal::RecordingReader& reader, Replay& result,
                   const std::function<std::string(const hal::RecordedCycle&)>& difference_in);

/// Replays a recording from a fresh reader.
Replay replay(hal::RecordingReader& reader);

/// Replays a file and prints the result. Returns the exit status. 0: every recorded cycle has the same bits. 1: a cycle
/// differs, or follows a gap and cannot be proved. 6: the file is refused or damaged.
int run_replay(const std::string& path, bool json);

}  // namespace hotfire::firmware
