// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/interlock/button.hpp"
#include "firmware/interlock/faults.hpp"

namespace hotfire::firmware {

/// - `safe`: nothing is driven.
/// - `armed`: a person has armed; the supply is enabled and every actuator is held at its position.
/// - `running`: the profile commands.
/// - `stopping`: the actuators are brought to rest.
/// - `faulted`: nothing is driven, and the faults are kept until a person arms again.
enum class RigState : std::uint8_t { safe, armed, running, stopping, faulted };
inline constexpr std::array<std::string_view, 5> kRigStates{"safe", "armed", "running", "stopping", "faulted"};

/// Whether commands may be sent and the supply is on.
constexpr bool drives(RigState state) noexcept { return state != RigState::safe && state != RigState::faulted; }

/// How an interlock is set up. Times are in cycles.
struct InterlockSettings {
  bool start_is_arm = false;        ///< there is no button to start with: the arm button is held for `start_hold`
  std::uint32_t debounce = 0;       ///< for which a button has to say the same
  std::uint32_t start_hold = 1;     ///< for which the start button has to be held at least
  std::uint32_t longest_press = 1;  ///< a button that is on for longer is stuck
  std::uint32_t least_armed = 0;    ///< before a start may begin
  std::uint32_t most_armed = 1;     ///< after which an armed rig is safe again
  std::uint32_t most_stopping = 0;  ///< after which a stopping rig is safe, whether it is at rest or not
};

/// The inputs of an interlock in one cycle.
struct InterlockInputs {
  FaultSet causes;             ///< faults whose cause is present now
  bool arm = false;            ///< what the line of the arm button says
  bool arm_changed = false;    ///< that line has changed since the cycle before, for however short a time
  bool start = false;          ///< as `arm`
  bool start_changed = false;  ///< as `arm_changed`
  bool stop = false;           ///< acts while it is on; also when the profile has ended
  bool at_rest = false;        ///< every actuator is at rest
  /// An output that was switched off still reads on: a press to arm is refused. It becomes a fault after `read_back_cycles`.
  bool supply_still_on = false;
};

/// The memory of an interlock between two cycles. The default is that at the start of a program.
struct InterlockMemory {
  RigState state = RigState::safe;
  std::uint32_t cycles = 0;  ///< in a state that is timed: how many it has lasted
  Contact arm_contact;
  Contact start_contact;
  Button arm;
  Button start;
  FaultSet faults;        ///< kept since the last arming
  Fault first = Fault{};  ///< the one that came first, 0 if none; of several in one cycle the lowest number

  friend constexpr bool operator==(const InterlockMemory&, const InterlockMemory&) noexcept = default;
};

/// The memory for the next cycle, and the results that hold for this cycle only.
struct InterlockDecision {
  InterlockMemory memory;
  bool refused_press = false;  ///< the arm button was pressed while something forbade arming
};

namespace interlock_rules {

constexpr InterlockMemory entered(InterlockMemory memory, RigState state) noexcept {
  if (state == memory.state) {
    const bool timed = state == RigState::armed || state == RigState::stopping;
    memory.cycles += timed ? 1 : 0;
    return memory;
  }
  // The buttons have to be seen off anew: what they showed was meant for the state before.
  memory.arm = memory.start = {};
  memory.cycles = state == RigState::armed || state == RigState::stopping ? 1 : 0;
  memory.state = state;
  return memory;
}

constexpr InterlockMemory with_faults(InterlockMemory memory, FaultSet causes) noexcept {
  const auto* const lowest =
      std::find_if(kFaults.begin(), kFaults.end(), [&](const FaultText& text) { return causes.has(text.fault); });
  memory.first = memory.faults.any() ? memory.first : lowest->fault;
  memory.faults |= causes;
  return memory;
}

/// The next state if no cause of a fault is present. `arm` and `start`: a press was completed in this cycle.
constexpr RigState next_state(const InterlockSettings& settings, const InterlockMemory& memory,
                              const InterlockInputs& inputs, bool arm, bool start) noexcept {
  switch (memory.state) {
    case RigState::safe:
    case RigState::faulted:
      return arm ? RigState::armed : memory.state;
    case RigState::armed:
      if (inputs.stop || memory.cycles >= settings.most_armed) {
        return RigState::safe;
      }
      return start ? RigState::running : RigState::armed;
    case RigState::running:
      return inputs.stop ? RigState::stopping : RigState::running;
    case RigState::stopping:
      return inputs.at_rest || memory.cycles > settings.most_stopping ? RigState::safe : RigState::stopping;
  }
  return RigState::faulted;
}

}  // namespace interlock_rules

/// Decides whether anything may be driven. The rules apply in this order:
///
/// 1. A cause of a fault while anything is driven makes the rig `faulted` in the same cycle; nothing is driven any more. The
///   causes of `kFaultsOfASafeRig` do so in `safe` too.
/// 2. Only a person's arming ends `faulted` or `safe`. This is a press of the arm button (`press`) from its beginning to its
///   end in that state. During the press no cause is present, no stop is requested and the supply reads off.
/// 3. A press of the start button leads from `armed` to `running`. It begins at least `least_armed` after the arming. After
///   `most_armed` the rig is `safe` again.
/// 4. `stop` leads from `armed` to `safe` and from `running` to `stopping`. `stopping` ends in `safe` when the actuators are
///   at rest, and after `most_stopping` in any case.
///
/// A function of its arguments: no clock, no bus, no allocation.
constexpr InterlockDecision decide(const InterlockSettings& settings, InterlockMemory memory,
                                   const InterlockInputs& inputs) noexcept {
  using namespace interlock_rules;
  memory.arm_contact = settled(memory.arm_contact, inputs.arm, inputs.arm_changed, settings.debounce);
  memory.start_contact = settings.start_is_arm
                             ? memory.arm_contact
                             : settled(memory.start_contact, inputs.start, inputs.start_changed, settings.debounce);
  const bool driven = drives(memory.state);
  const bool forbidden = inputs.causes.any() || inputs.stop || (!driven && inputs.supply_still_on);
  const Press arm =
      driven ? Press::none : press(memory.arm, memory.arm_contact, true, forbidden, {1, settings.longest_press});
  const Press start = memory.state != RigState::armed
                          ? Press::none
                          : press(memory.start, memory.start_contact, memory.cycles >= settings.least_armed, forbidden,
                                  {settings.start_hold, settings.longest_press});
  const FaultSet causes = memory.state == RigState::safe ? inputs.causes & kFaultsOfASafeRig : inputs.causes;
  if (causes.any()) {
    return {entered(with_faults(memory, inputs.causes), RigState::faulted), arm == Press::refused};
  }
  const RigState state = next_state(settings, memory, inputs, arm == Press::good, start == Press::good);
  if (!driven && drives(state)) {
    memory.faults = {};
    memory.first = {};
  }
  return {entered(memory, state), arm == Press::refused};
}

/// What is allowed in the cycle of a decision.
struct InterlockOutputs {
  RigState state = RigState::safe;
  bool drive = false;          ///< commands may be sent and the supply is enabled
  bool fault_out = false;      ///< the fault line to the rest of the rig
  bool refused_press = false;  ///< as in `InterlockDecision`
  FaultSet faults;             ///< as in `InterlockMemory`
  Fault first = Fault{};
};

/// `decide`, cycle after cycle. Starts `safe`.
class Interlock {
 public:
  explicit Interlock(const InterlockSettings& settings) noexcept : settings_(settings) {}

  InterlockOutputs step(const InterlockInputs& inputs) noexcept {
    const InterlockDecision decision = decide(settings_, memory_, inputs);
    memory_ = decision.memory;
    return {memory_.state,          drives(memory_.state), memory_.state == RigState::faulted,
            decision.refused_press, memory_.faults,        memory_.first};
  }

 private:
  InterlockSettings settings_;
  InterlockMemory memory_;
};

}  // namespace hotfire::firmware
