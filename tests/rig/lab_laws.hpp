// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "firmware/interlock/interlock.hpp"

namespace hotfire::test {

/// Whether the interlock may be in state `now` in the cycle after `before`.
constexpr bool may_follow(firmware::RigState before, firmware::RigState now) noexcept {
  using firmware::RigState;
  switch (before) {
    case RigState::safe:
      return now == RigState::safe || now == RigState::armed || now == RigState::faulted;
    case RigState::armed:
      return now != RigState::stopping;
    case RigState::running:
      return now != RigState::armed && now != RigState::safe;
    case RigState::stopping:
      return now != RigState::armed && now != RigState::running;
    case RigState::faulted:
      return now == RigState::faulted || now == RigState::armed;
  }
  return false;
}

/// What every cycle of a recording was checked for, and how much happened in it.
struct LawsOfARecording {
  std::string broken{};  ///< the first law that does not hold, with its cycle; empty if all hold in every cycle
  std::uint64_t cycles = 0;
  std::uint64_t drove = 0;    ///< cycles
  std::uint64_t running = 0;  ///< times that a profile was started
};

/// Checks every cycle of a recording of a lab by laws that are written apart from its logic: a state is followed by a state
/// that it leads to; `armed` is entered in a cycle after the arm button was seen off and then on; nothing is driven in a
/// cycle that was given a cause of a fault; commands are finite and below `highest_position` [m]. If the
/// program ended by itself (`ended`), the recording is closed and its last cycle drives nothing.
LawsOfARecording laws_of(const std::string& path, double highest_position, bool ended);

}  // namespace hotfire::test
