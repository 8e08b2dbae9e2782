// SPDX-License-Identifier: Apache-2.0
// The interlock is a function of its memory and its inputs. These tests visit every memory that any sequence of inputs can
// lead to, and look at every input there: what they say holds for every sequence, however long. Times are short so that the
// memories are few; the law of a time does not depend on its length. Of causes `decide` asks only whether there are any and
// whether any is of a safe rig, so that none, one of each kind and both stand for all; every single fault is tried too.

#include "firmware/interlock/interlock.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <unordered_set>
#include <vector>

#include <CppUTest/TestHarness.h>

namespace hotfire::firmware {

namespace {

/// Start is a button of its own, and the arm button held. The least time in `armed` has room for two presses, so that it is
/// that time alone which forbids them.
constexpr std::array<InterlockSettings, 2> kSettings{{{false, 1, 1, 4, 12, 20, 2}, {true, 1, 2, 5, 14, 24, 2}}};

struct HashOfMemory {
  std::size_t operator()(const InterlockMemory& memory) const noexcept {
    std::size_t hash = 0;
    const auto add = [&hash](std::size_t part) { hash = hash * 1'000'003 + part; };
    add(static_cast<std::size_t>(memory.state));
    add(memory.cycles);
    for (const Contact& contact : {memory.arm_contact, memory.start_contact}) {
      add(2 * contact.differing + (contact.on ? 1 : 0));
    }
    for (const Button& button : {memory.arm, memory.start}) {
      add(4 * button.held + (button.ready ? 2 : 0) + (button.refused ? 1 : 0));
    }
    add(static_cast<std::size_t>(memory.first));
    add(static_cast<std::size_t>(memory.faults.count()));
    return hash;
  }
};

using Memories = std::unordered_set<InterlockMemory, HashOfMemory>;

/// Every combination of lines, with each of the causes.
std::vector<InterlockInputs> every_input(const std::vector<FaultSet>& causes) {
  std::vector<InterlockInputs> inputs;
  for (const FaultSet cause : causes) {
    for (unsigned bits = 0; bits < 128; ++bits) {
      const auto bit = [bits](unsigned place) { return ((bits >> place) & 1U) != 0; };
      inputs.push_back({cause, bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6)});
    }
  }
  return inputs;
}

const std::vector<FaultSet> kKindsOfCauses{
    {}, Fault::emergency_stop, Fault::supply_read_back, FaultSet(Fault::emergency_stop) | Fault::supply_read_back};

/// All that can be reached from some memories by inputs of a list; `on_step` sees every step on the way.
Memories reached(
    const InterlockSettings& settings, const Memories& from, const std::vector<InterlockInputs>& inputs,
    const std::function<void(const InterlockMemory&, const InterlockInputs&, const InterlockDecision&)>& on_step =
        [](const auto&, const auto&, const auto&) {}) {
  Memories seen = from;
  std::vector<InterlockMemory> open(from.begin(), from.end());
  while (!open.empty()) {
    const InterlockMemory memory = open.back();
    open.pop_back();
    for (const InterlockInputs& input : inputs) {
      const InterlockDecision decision = decide(settings, memory, input);
      on_step(memory, input, decision);
      if (seen.insert(decision.memory).second) {
        open.push_back(decision.memory);
      }
    }
  }
  return seen;
}

Memories every_memory(const InterlockSettings& settings) {
  return reached(settings, {InterlockMemory{}}, every_input(kKindsOfCauses));
}

bool is_of_a_state(const Memories& memories, RigState state) {
  return std::any_of(memories.begin(), memories.end(),
                     [state](const InterlockMemory& memory) { return memory.state == state; });
}

/// Whether both buttons are off, have been seen so, and no press of either has begun.
bool is_quiet(const InterlockMemory& memory) {
  const auto off = [](const Contact& contact) { return contact == Contact{false, 0}; };
  return off(memory.arm_contact) && off(memory.start_contact) && memory.arm.held == 0 && memory.start.held == 0;
}

/// Whether inputs that do not change any more lead from a memory to motion.
bool leads_to_motion(const InterlockSettings& settings, InterlockMemory memory, InterlockInputs inputs) {
  // Longer than anything that is timed.
  const std::uint32_t cycles = settings.most_armed + settings.most_stopping + settings.longest_press + 10;
  for (std::uint32_t i = 0; i < cycles && memory.state != RigState::running; ++i) {
    memory = decide(settings, memory, inputs).memory;
    inputs.arm_changed = inputs.start_changed = false;
  }
  return memory.state == RigState::running;
}

/// What a line may do at a moment, by its place among the inputs: be off or on, steadily or after a change.
constexpr std::array<bool InterlockInputs::*, 5> kLines{&InterlockInputs::arm, &InterlockInputs::start,
                                                        &InterlockInputs::stop, &InterlockInputs::at_rest,
                                                        &InterlockInputs::supply_still_on};

/// Inputs of which one thing alone is other than before: a line, or a cause that comes or goes.
std::vector<InterlockInputs> single_events(const InterlockInputs& before) {
  std::vector<InterlockInputs> events;
  for (bool InterlockInputs::*line : kLines) {
    events.push_back(before);
    events.back().*line = !(before.*line);
    events.back().arm_changed = line == &InterlockInputs::arm;
    events.back().start_changed = line == &InterlockInputs::start;
  }
  for (const FaultSet causes : kKindsOfCauses) {
    events.push_back(before);
    events.back().causes = causes;
  }
  return events;
}

}  // namespace

TEST_GROUP(InterlockProof){};

TEST(InterlockProof, EveryStateIsReachedSoThatWhatFollowsIsSaidOfAll) {
  for (const InterlockSettings& settings : kSettings) {
    const Memories memories = every_memory(settings);
    for (const RigState state :
         {RigState::safe, RigState::armed, RigState::running, RigState::stopping, RigState::faulted}) {
      CHECK(is_of_a_state(memories, state));
    }
    CHECK(memories.size() > 200);
  }
}

TEST(InterlockProof, EveryFaultInEveryMemoryEndsDrivingInTheCycleThatIsGivenIt) {
  std::vector<FaultSet> causes{FaultSet::all()};
  for (const FaultText& text : kFaults) {
    causes.emplace_back(text.fault);
  }
  const std::vector<InterlockInputs> inputs = every_input(causes);
  for (const InterlockSettings& settings : kSettings) {
    for (const InterlockMemory& memory : every_memory(settings)) {
      for (const InterlockInputs& input : inputs) {
        const InterlockMemory next = decide(settings, memory, input).memory;
        CHECK(!drives(next.state));
        CHECK(!drives(memory.state) || (next.state == RigState::faulted && next.faults.any()));
      }
    }
  }
}

TEST(InterlockProof, NothingIsDrivenUnlessTheArmButtonWasPressedAndLetGo) {
  for (const InterlockSettings& settings : kSettings) {
    std::vector<InterlockInputs> without_arm = every_input(kKindsOfCauses);
    std::erase_if(without_arm, [](const InterlockInputs& input) { return input.arm; });
    std::vector<InterlockInputs> never_let_go = every_input(kKindsOfCauses);
    std::erase_if(never_let_go, [](const InterlockInputs& input) { return !input.arm; });
    const std::vector<InterlockInputs> every = every_input(kKindsOfCauses);
    Memories undriven = every_memory(settings);
    std::erase_if(undriven, [](const InterlockMemory& memory) { return drives(memory.state); });
    // A press that has begun may end without the button's going on again.
    Memories not_pressed = undriven;
    std::erase_if(not_pressed, [](const InterlockMemory& memory) { return memory.arm.held > 0 || memory.arm_contact.on; });
    for (const InterlockMemory& memory : reached(settings, not_pressed, without_arm)) {
      CHECK(!drives(memory.state));
    }
    not_pressed.clear();
    std::copy_if(undriven.begin(), undriven.end(), std::inserter(not_pressed, not_pressed.end()), is_quiet);
    for (const InterlockMemory& memory : reached(settings, not_pressed, never_let_go)) {
      CHECK(!drives(memory.state));
    }
    // Nor is a step from undriven to driven anything but to `armed`, and none to `running` but from there.
    reached(settings, {InterlockMemory{}}, every, [](const auto& before, const auto&, const InterlockDecision& decision) {
      const RigState after = decision.memory.state;
      CHECK(drives(before.state) || !drives(after) || after == RigState::armed);
      CHECK(after != RigState::running || before.state == RigState::running || before.state == RigState::armed);
    });
  }
}

TEST(InterlockProof, NoPressDuringWhichTheSupplyStillReadOnArms) {
  const std::vector<InterlockInputs> inputs = every_input({FaultSet{}});
  for (const InterlockSettings& settings : kSettings) {
    for (const InterlockMemory& memory : every_memory(settings)) {
      if (drives(memory.state)) {
        continue;
      }
      for (InterlockInputs input : inputs) {
        input.supply_still_on = true;
        InterlockMemory later = decide(settings, memory, input).memory;
        CHECK(!drives(later.state));
        // Nor if the press goes on, or ends, when it no longer does.
        input = {};
        for (std::uint32_t cycle = 0; cycle < settings.longest_press + settings.debounce + 2; ++cycle) {
          later = decide(settings, later, input).memory;
          CHECK(!drives(later.state));
        }
      }
    }
  }
}

TEST(InterlockProof, FromNoMemoryWithQuietButtonsDoesASingleEventLeadToMotion) {
  const std::vector<InterlockInputs> inputs = every_input(kKindsOfCauses);
  std::size_t looked_at = 0;
  for (const InterlockSettings& settings : kSettings) {
    for (const InterlockMemory& memory : every_memory(settings)) {
      if (memory.state == RigState::running || !is_quiet(memory)) {
        continue;
      }
      for (const InterlockInputs& before : inputs) {
        if (before.arm || before.start || before.arm_changed || before.start_changed) {
          continue;
        }
        for (const InterlockInputs& event : single_events(before)) {
          CHECK(!leads_to_motion(settings, memory, event));
          ++looked_at;
        }
      }
    }
  }
  CHECK(looked_at > 1000);
}

TEST(InterlockProof, WithAStartButtonNoSingleLineLeadsFromAnUndrivenRigToMotionWhateverItDoes) {
  const InterlockSettings& settings = kSettings[0];
  Memories undriven;
  for (const InterlockMemory& memory : every_memory(settings)) {
    if (!drives(memory.state) && is_quiet(memory)) {
      undriven.insert(memory);
    }
  }
  CHECK(!undriven.empty());
  for (bool InterlockInputs::*line : kLines) {
    // The others stay as they are: buttons off; of stop and rest, every way.
    for (unsigned bits = 0; bits < 4; ++bits) {
      std::vector<InterlockInputs> anything;
      for (unsigned own = 0; own < 4; ++own) {
        InterlockInputs input;
        input.stop = (bits & 1U) != 0;
        input.at_rest = (bits & 2U) != 0;
        input.*line = (own & 1U) != 0;
        const bool changed = (own & 2U) != 0;
        input.arm_changed = line == &InterlockInputs::arm && changed;
        input.start_changed = line == &InterlockInputs::start && changed;
        anything.push_back(input);
      }
      CHECK(!is_of_a_state(reached(settings, undriven, anything), RigState::running));
    }
  }
}

TEST(InterlockProof, NoSequenceOfEdgesWithinTheLeastTimeInArmedLeadsToMotionWhateverFollowsWithoutAnEdge) {
  const std::vector<InterlockInputs> inputs = every_input({FaultSet{}});
  for (const InterlockSettings& settings : kSettings) {
    Memories now;
    for (const InterlockMemory& memory : every_memory(settings)) {
      if (!drives(memory.state) && is_quiet(memory)) {
        now.insert(memory);
      }
    }
    Memories seen;
    for (std::uint32_t cycle = 0; cycle < settings.least_armed; ++cycle) {
      Memories next;
      for (const InterlockMemory& memory : now) {
        for (const InterlockInputs& input : inputs) {
          next.insert(decide(settings, memory, input).memory);
        }
      }
      now = std::move(next);
      seen.insert(now.begin(), now.end());
    }
    CHECK(!is_of_a_state(seen, RigState::running));
    CHECK(is_of_a_state(seen, RigState::armed));
    for (const InterlockMemory& memory : seen) {
      for (const InterlockInputs& input : inputs) {
        CHECK(input.arm_changed || input.start_changed || !leads_to_motion(settings, memory, input));
      }
    }
  }
}

TEST(InterlockProof, WhatIsDrivenEndsInItsTimeWithoutAPerson) {
  for (const InterlockSettings& settings : kSettings) {
    for (const InterlockMemory& memory : every_memory(settings)) {
      if (memory.state != RigState::armed && memory.state != RigState::stopping) {
        continue;
      }
      InterlockMemory later = memory;
      const std::uint32_t most = memory.state == RigState::armed ? settings.most_armed : settings.most_stopping + 1;
      std::uint32_t cycles = 0;
      while (later.state == memory.state && cycles <= most) {
        later = decide(settings, later, {}).memory;
        ++cycles;
      }
      CHECK(cycles <= most);
      CHECK(memory.state == RigState::armed || later.state == RigState::safe);
    }
  }
}

}  // namespace hotfire::firmware
