// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/lab_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/interlock/faults.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "hal/recording/reader.hpp"

namespace hotfire::test {
namespace {

using firmware::RigState;
using Head = hal::CycleHead;

constexpr double kPistonPerCommand = 0.5;

/// A cause that ends driving in the cycle that is given it, whatever came before.
bool has_cause(const firmware::ObservedRig& seen) {
  return seen.emergency_stop || !seen.hydraulic_enable || seen.bus_off || seen.bus_down || seen.bad_frame ||
         seen.second_sender || seen.transmit_queue_full || seen.dropped_recording || seen.not_authentic ||
         seen.command_not_answered || seen.take_back_refused;
}

/// The same of what the sensors read: beyond a limit, not finite, or two readings that disagree.
bool has_cause(const firmware::LabInputs& inputs, std::size_t actuators, double highest_position) {
  constexpr double kDisagreement = 1e-3;
  for (std::size_t i = 0; i < actuators; ++i) {
    const auto& [first, second] = inputs.readings[i];
    // A reading that is not finite fulfils neither.
    if (!(std::abs(first) <= highest_position && std::abs(second) <= highest_position) ||
        !(std::abs(first - second) <= kDisagreement)) {
      return true;
    }
  }
  return has_cause(inputs.rig);
}

}  // namespace

LawsOfARecording laws_of(const std::string& path, double highest_position, bool ended) {
  LawsOfARecording result;
  hal::RecordingReader reader(path);
  result.broken = reader.error();
  hal::RecordedCycle cycle;
  RigState before = RigState::safe;
  std::uint64_t dropped = 0;
  bool seen_off = false;
  bool seen_on_after_off = false;
  const auto expect = [&](bool good, const char* law) {
    if (!good && result.broken.empty()) {
      result.broken = "cycle " + std::to_string(cycle.head.cycle) + ": " + law;
    }
  };
  while (result.broken.empty() && reader.next(cycle)) {
    ++result.cycles;
    dropped += cycle.dropped_before;
    const auto state = static_cast<RigState>((cycle.head.flags >> Head::kStateShift) & 0xff);
    const firmware::LabInputs inputs = firmware::recorded_inputs(cycle);
    const bool follows = cycle.dropped_before == 0;
    expect(!follows || may_follow(before, state), "a state that the one before does not lead to");
    if (!follows) {
      // What was pressed in a cycle that is not in the file is not known.
      seen_off = seen_on_after_off = true;
    }
    seen_on_after_off = seen_on_after_off || (seen_off && inputs.arm);
    seen_off = seen_off || !inputs.arm;
    if (state != before) {
      expect(state != RigState::armed || seen_on_after_off, "armed, and nobody had pressed");
      result.running += state == RigState::running ? 1 : 0;
      seen_off = seen_on_after_off = false;
    }
    expect(!drives(state) || !has_cause(inputs, cycle.commands.size(), highest_position),
           "drives, and was given the cause of a fault");
    expect(std::ranges::all_of(cycle.commands,
                               [&](double command) {
                                 return std::isfinite(command) &&
                                        (!drives(state) || std::abs(kPistonPerCommand * command) <= highest_position);
                               }),
           "a command that is not finite, or beyond its limit");
    result.drove += drives(state) ? 1 : 0;
    before = state;
  }
  expect(result.cycles > 0, "no cycle is recorded");
  expect(!ended || reader.end() == hal::RecordingReader::End::closed, "the program has ended and not closed its recording");
  // What a stalled disk cost at the end is not in the file.
  expect(!ended || reader.dropped() > dropped || !drives(before), "the last cycle drives");
  return result;
}

}  // namespace hotfire::test
