#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/interlock/faults.hpp"

namespace hotfire::firmware {

/// - `safe`: nothing is driven.
/// - `armed`: a person has armed; supply enabled, every actuator held where it is.
/// - `running`: the profile commands.
/// - `stopping`: the actuators are brought to rest.
/// - `faulted`: nothing is driven, and the faults are kept for the person who comes to look.
enum class RigState : std::uint8_t { safe, armed, running, stopping, faulted };
inline constexpr std::array<std::string_view, 5> kRigStates{"safe", "armed", "running", "stopping", "faulted"};

/// What an interlock sees in one cycle.
struct InterlockInputs {
  FaultSet causes;       ///< faults whose cause is present now
  bool arm = false;      ///< a person's switch: acts when it goes on, not while it is on
  bool start = false;    ///< as `arm`
  bool stop = false;     ///< acts while it is on; also when the profile has ended
  bool at_rest = false;  ///< every actuator stands still
};

/// What may be done in the cycle that these inputs are of.
struct InterlockOutputs {
  RigState state = RigState::safe;
  bool drive = false;      ///< commands may be sent and the supply is enabled
  bool fault_out = false;  ///< the fault line to the rest of the rig
  FaultSet faults;         ///< kept since the last arming
  Fault first = Fault{};   ///< the one that came first, 0 if none; of several in one cycle the lowest number
};

/// Decides whether anything may be driven. Rules, in this order:
///
/// 1. A cause that is present while anything is driven makes the rig `faulted` in the same cycle; nothing is driven any
/// more.
/// 2. Nothing leaves `faulted` or `safe` but a person's arming: the switch must have been seen off in that state, and then
/// goes
///    on, with no cause present. So a switch left on, a program that starts anew or a cause that goes away arms nothing. An
///    arming that is refused needs the switch off and on again.
/// 3. `armed` to `running`: `start` goes on, having been seen off in `armed`.
/// 4. `stop` brings `armed` to `safe` and `running` to `stopping`, which ends in `safe` when the actuators are at rest, or
/// after
///    `most_stopping_cycles` whether they are or not.
///
/// Pure logic: no clock, no bus, no allocation. Starts `safe`.
class Interlock {
 public:
  explicit Interlock(std::uint64_t most_stopping_cycles) noexcept : most_stopping_cycles_(most_stopping_cycles) {}

  InterlockOutputs step(const InterlockInputs& inputs) noexcept {
    const bool arm = arm_.goes_on(inputs.arm);
    const bool start = start_.goes_on(inputs.start);
    const RigState before = outputs_.state;
    if (inputs.causes.any() && before != RigState::safe) {
      keep(inputs.causes);
      enter(RigState::faulted);
    } else {
      enter(next(inputs, arm, start));
    }
    return outputs_;
  }

  const InterlockOutputs& outputs() const noexcept { return outputs_; }

 private:
  /// A switch that acts when it goes on, and only if it was seen off since the state began.
  class Switch {
   public:
    bool goes_on(bool on) noexcept {
      const bool acts = on && seen_off_;
      seen_off_ = !on;
      return acts;
    }
    void forget() noexcept { seen_off_ = false; }

   private:
    bool seen_off_ = false;
  };

  RigState next(const InterlockInputs& inputs, bool arm, bool start) noexcept {
    switch (outputs_.state) {
      case RigState::safe:
      case RigState::faulted:
        if (arm && !inputs.causes.any()) {
          outputs_.faults = {};
          outputs_.first = {};
          return RigState::armed;
        }
        return outputs_.state;
      case RigState::armed:
        if (inputs.stop) {
          return RigState::safe;
        }
        return start ? RigState::running : RigState::armed;
      case RigState::running:
        return inputs.stop ? RigState::stopping : RigState::running;
      case RigState::stopping:
        return inputs.at_rest || ++stopping_cycles_ > most_stopping_cycles_ ? RigState::safe : RigState::stopping;
    }
    return RigState::faulted;
  }

  void enter(RigState state) noexcept {
    if (state != outputs_.state) {
      // The switches have to be seen off anew: what they showed was meant for the state before.
      arm_.forget();
      start_.forget();
      stopping_cycles_ = 0;
    }
    outputs_.state = state;
    outputs_.drive = state != RigState::safe && state != RigState::faulted;
    outputs_.fault_out = state == RigState::faulted;
  }

  void keep(FaultSet causes) noexcept {
    for (const FaultText& text : kFaults) {
      if (!outputs_.faults.any() && causes.has(text.fault)) {
        outputs_.first = text.fault;
        break;
      }
    }
    outputs_.faults |= causes;
  }

  std::uint64_t most_stopping_cycles_;
  std::uint64_t stopping_cycles_ = 0;
  Switch arm_;
  Switch start_;
  InterlockOutputs outputs_;
};

}  // namespace hotfire::firmware
