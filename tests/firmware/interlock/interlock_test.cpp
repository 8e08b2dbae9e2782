#include "firmware/interlock/interlock.hpp"

#include <CppUTest/TestHarness.h>

#include <string>
#include <vector>

namespace hotfire::firmware {

namespace {

constexpr std::uint64_t kMostStopping = 3;

/// Every combination of switches, with no cause and with each.
std::vector<InterlockInputs> every_input() {
  std::vector<FaultSet> causes{{}};
  for (const FaultText& text : kFaults) {
    causes.emplace_back(text.fault);
  }
  causes.push_back(FaultSet::all());
  std::vector<InterlockInputs> inputs;
  for (const FaultSet cause : causes) {
    for (unsigned bits = 0; bits < 16; ++bits) {
      inputs.push_back({cause, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0});
    }
  }
  return inputs;
}

constexpr InterlockInputs kOff{};
constexpr InterlockInputs kArm{{}, true};
constexpr InterlockInputs kStart{{}, false, true};
constexpr InterlockInputs kStop{{}, false, false, true};

InterlockInputs caused(Fault fault) {
  InterlockInputs inputs;
  inputs.causes = fault;
  return inputs;
}

/// An interlock that has been brought to a state, its switches off and seen so.
Interlock in(RigState state) {
  Interlock interlock(kMostStopping);
  interlock.step(kOff);
  if (state == RigState::safe) {
    return interlock;
  }
  interlock.step(kArm);
  interlock.step(kOff);
  if (state == RigState::running || state == RigState::stopping) {
    interlock.step(kStart);
    interlock.step(kOff);
  }
  if (state == RigState::stopping) {
    interlock.step(kStop);
  }
  if (state == RigState::faulted) {
    interlock.step(caused(Fault::overrun));
    interlock.step(kOff);
  }
  CHECK(interlock.outputs().state == state);
  return interlock;
}

constexpr std::array<RigState, 5> kEveryState{RigState::safe, RigState::armed, RigState::running, RigState::stopping,
                                              RigState::faulted};

bool drives(RigState state) { return state != RigState::safe && state != RigState::faulted; }

/// Whether an interlock in a state, which has seen the arm switch off in it or not, may answer these inputs so.
bool obeys_the_rules(RigState state, bool seen_off, const InterlockInputs& inputs, const InterlockOutputs& outputs) {
  const bool armed_now = inputs.arm && seen_off && !inputs.causes.any();
  const bool says_what_it_does =
      outputs.drive == drives(outputs.state) && outputs.fault_out == (outputs.state == RigState::faulted);
  const bool no_cause_is_driven_over = !inputs.causes.any() || !outputs.drive;
  const bool only_a_person_arms = !outputs.drive || drives(state) || armed_now;
  const bool only_start_runs =
      outputs.state != RigState::running || state == RigState::running || (state == RigState::armed && inputs.start);
  const bool fault_stays = state != RigState::faulted || outputs.state == RigState::faulted || armed_now;
  return says_what_it_does && no_cause_is_driven_over && only_a_person_arms && only_start_runs && fault_stays;
}

}  // namespace

TEST_GROUP(Interlock){};

TEST(Interlock, StartsSafeAndDrivesNothing) {
  const Interlock interlock(kMostStopping);
  CHECK(interlock.outputs().state == RigState::safe);
  CHECK(!interlock.outputs().drive);
}

TEST(Interlock, EveryFaultInEveryStateThatDrivesStopsItInTheSameCycle) {
  for (const RigState state : kEveryState) {
    for (const FaultText& text : kFaults) {
      Interlock interlock = in(state);
      const InterlockOutputs outputs = interlock.step(caused(text.fault));
      CHECK(!outputs.drive);
      CHECK(outputs.state == (state == RigState::safe ? RigState::safe : RigState::faulted));
      CHECK(outputs.fault_out == (state != RigState::safe));
      if (drives(state)) {
        CHECK(outputs.first == text.fault);
        CHECK(outputs.faults == FaultSet(text.fault));
      }
    }
  }
}

TEST(Interlock, NothingLeavesAFaultUntilAPersonArms) {
  for (const FaultText& text : kFaults) {
    Interlock interlock = in(RigState::running);
    interlock.step(caused(text.fault));
    for (int cycle = 0; cycle < 20; ++cycle) {
      // The cause is gone; start, stop and standing still change nothing.
      const InterlockOutputs outputs = interlock.step({{}, false, cycle % 2 == 1, cycle % 3 == 1, cycle % 5 == 1});
      CHECK(outputs.state == RigState::faulted);
      CHECK(!outputs.drive);
    }
    CHECK(interlock.step(kArm).state == RigState::armed);
    CHECK(!interlock.outputs().faults.any());
  }
}

TEST(Interlock, ArmingIsRefusedWhileACauseIsPresentAndNeedsTheSwitchAnew) {
  for (const RigState state : {RigState::safe, RigState::faulted}) {
    for (const FaultText& text : kFaults) {
      Interlock interlock = in(state);
      InterlockInputs refused = kArm;
      refused.causes = text.fault;
      CHECK(interlock.step(refused).state == state);
      // The cause goes away with the switch still on.
      CHECK(interlock.step(kArm).state == state);
      CHECK(interlock.step(kOff).state == state);
      CHECK(interlock.step(kArm).state == RigState::armed);
    }
  }
}

TEST(Interlock, SwitchThatIsOnWhenTheProgramStartsArmsNothing) {
  Interlock interlock(kMostStopping);
  for (int cycle = 0; cycle < 10; ++cycle) {
    CHECK(interlock.step(kArm).state == RigState::safe);
  }
  interlock.step(kOff);
  CHECK(interlock.step(kArm).state == RigState::armed);
}

TEST(Interlock, StartActsOnlyWhenItWasSeenOffWhileArmed) {
  Interlock interlock = in(RigState::safe);
  CHECK(interlock.step({{}, true, true}).state == RigState::armed);
  CHECK(interlock.step(kStart).state == RigState::armed);
  interlock.step(kStop);
  interlock.step(kOff);
  // It was seen off, but while safe.
  CHECK(interlock.step(kArm).state == RigState::armed);
  CHECK(interlock.step(kStart).state == RigState::armed);
  interlock.step(kOff);
  CHECK(interlock.step(kStart).state == RigState::running);
}

TEST(Interlock, StopEndsArmedAtOnceAndBringsRunningToRest) {
  Interlock armed = in(RigState::armed);
  CHECK(armed.step(kStop).state == RigState::safe);
  Interlock running = in(RigState::running);
  CHECK(running.step(kStop).state == RigState::stopping);
  CHECK(running.outputs().drive);
  CHECK(running.step({{}, false, false, false, true}).state == RigState::safe);
  CHECK(!running.outputs().drive);
}

TEST(Interlock, StoppingEndsAfterItsCyclesWhetherTheActuatorsRestOrNot) {
  Interlock interlock = in(RigState::stopping);
  std::uint64_t cycles = 0;
  while (interlock.step(kOff).state == RigState::stopping) {
    ++cycles;
  }
  UNSIGNED_LONGS_EQUAL(kMostStopping, cycles);
  CHECK(interlock.outputs().state == RigState::safe);
}

TEST(Interlock, FaultsAreKeptTogetherAndTheFirstIsNamed) {
  Interlock interlock = in(RigState::running);
  interlock.step(caused(Fault::bus_down));
  interlock.step(caused(Fault::emergency_stop));
  const InterlockOutputs outputs = interlock.step(kOff);
  CHECK(outputs.first == Fault::bus_down);
  CHECK(outputs.faults == (FaultSet(Fault::bus_down) | Fault::emergency_stop));
}

// Every sequence of six inputs would be millions; every pair after every state, and the rules that must hold in each step,
// is the whole of it: an interlock remembers no more than its state and what its switches showed in the cycle before.
TEST(Interlock, RulesHoldForEveryPairOfInputsInEveryState) {
  const std::vector<InterlockInputs> inputs = every_input();
  for (const RigState state : kEveryState) {
    const Interlock start = in(state);
    for (const InterlockInputs& first : inputs) {
      Interlock once = start;
      const RigState between = once.step(first).state;
      for (const InterlockInputs& second : inputs) {
        Interlock twice = once;
        const InterlockOutputs outputs = twice.step(second);
        const bool seen_off = between == start.outputs().state && !first.arm;
        CHECK(obeys_the_rules(between, seen_off, second, outputs));
      }
    }
  }
}

}  // namespace hotfire::firmware
