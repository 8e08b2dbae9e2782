// SPDX-License-Identifier: Apache-2.0
#include "firmware/interlock/interlock.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

namespace hotfire::firmware {

namespace {

/// Times as short as they can be told apart.
constexpr InterlockSettings kShort{false, 0, 2, 8, 3, 9, 3};

InterlockInputs caused(Fault fault) {
  InterlockInputs inputs;
  inputs.causes = fault;
  return inputs;
}

}  // namespace

TEST_GROUP(Interlock) {
  InterlockSettings settings = kShort;
  Interlock interlock{settings};
  InterlockInputs inputs;
  InterlockOutputs outputs;

  InterlockOutputs step(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      outputs = interlock.step(inputs);
    }
    return outputs;
  }

  void begin() {
    interlock = Interlock(settings);
    inputs = {};
    step();
  }

  /// A button goes on for so many cycles, and off.
  InterlockOutputs press_for(bool InterlockInputs::*button, int cycles) {
    inputs.*button = true;
    step(cycles);
    inputs.*button = false;
    return step();
  }
  InterlockOutputs arm() { return press_for(&InterlockInputs::arm, 2); }
  InterlockOutputs start() {
    step(4);
    return press_for(&InterlockInputs::start, 2);
  }

  void bring_to(RigState state) {
    begin();
    if (state != RigState::safe) {
      arm();
    }
    if (state == RigState::running || state == RigState::stopping) {
      start();
    }
    if (state == RigState::stopping) {
      inputs.stop = true;
      step();
      inputs.stop = false;
    }
    if (state == RigState::faulted) {
      interlock.step(caused(Fault::overrun));
      step();
    }
    CHECK(outputs.state == state);
  }
};

TEST(Interlock, StartsSafeAndDrivesNothing) {
  CHECK(step().state == RigState::safe);
  CHECK(!outputs.drive);
}

TEST(Interlock, EveryFaultInEveryStateThatDrivesStopsItInTheSameCycle) {
  for (const RigState state : {RigState::armed, RigState::running, RigState::stopping}) {
    for (const FaultText& text : kFaults) {
      bring_to(state);
      outputs = interlock.step(caused(text.fault));
      CHECK(!outputs.drive && outputs.fault_out);
      CHECK(outputs.first == text.fault);
      CHECK(outputs.faults == FaultSet(text.fault));
    }
  }
}

TEST(Interlock, ASafeRigStaysSafeButForWhatShouldBeOff) {
  for (const FaultText& text : kFaults) {
    bring_to(RigState::safe);
    outputs = interlock.step(caused(text.fault));
    CHECK_EQUAL(kFaultsOfASafeRig.has(text.fault), outputs.fault_out);
    CHECK(outputs.first == (outputs.fault_out ? text.fault : Fault{}));
  }
}

TEST(Interlock, NothingLeavesAFaultUntilAPersonArms) {
  for (const FaultText& text : kFaults) {
    bring_to(RigState::running);
    interlock.step(caused(text.fault));
    for (int cycle = 0; cycle < 40; ++cycle) {
      // The cause is gone; start, stop and standing still change nothing.
      inputs.start = cycle % 6 < 3;
      inputs.stop = cycle % 3 == 1;
      inputs.at_rest = cycle % 5 == 1;
      CHECK(step().state == RigState::faulted);
    }
    inputs = {};
    step();
    CHECK(arm().state == RigState::armed);
    CHECK(!outputs.faults.any());
  }
}

TEST(Interlock, ArmingIsRefusedIfACauseWasPresentAtAnyTimeOfThePressAndNeedsAnother) {
  for (const RigState state : {RigState::safe, RigState::faulted}) {
    for (const FaultText& text : kFaults) {
      // From the last look at which the button is off to the one at which it is off again.
      for (int at = 0; at < 5; ++at) {
        bring_to(state);
        bool refused = false;
        for (int cycle = 0; cycle < 5; ++cycle) {
          inputs.arm = cycle > 0 && cycle < 4;
          inputs.causes = cycle == at ? FaultSet(text.fault) : FaultSet();
          refused = refused || step().refused_press;
        }
        // What makes a safe rig faulted has the press begin anew with the state.
        CHECK(refused || (state == RigState::safe && outputs.state == RigState::faulted));
        CHECK(!outputs.drive);
        inputs = {};
        step();
        CHECK(arm().state == RigState::armed);
      }
    }
  }
}

TEST(Interlock, PressWhoseLineWentOnBeforeTheFaultArmsNothingThoughItSettlesAfterIt) {
  constexpr int kDebounce = 3;
  settings.debounce = kDebounce;
  const auto press_and_let_go = [&] {
    inputs.arm = true;
    step(2 * kDebounce);
    inputs.arm = false;
    return step(2 * kDebounce).state;
  };
  for (int before = 1; before <= kDebounce; ++before) {
    begin();
    step(2 * kDebounce);
    CHECK(press_and_let_go() == RigState::armed);
    inputs.arm = true;
    step(before);
    inputs.causes = Fault::overrun;
    CHECK(step().state == RigState::faulted);
    inputs.causes = {};
    step(2 * kDebounce);
    inputs.arm = false;
    CHECK(step(2 * kDebounce).state == RigState::faulted);
    CHECK(press_and_let_go() == RigState::armed);
  }
}

TEST(Interlock, ButtonThatIsOnWhenTheProgramStartsArmsNothingWhenItIsLetGo) {
  inputs.arm = true;
  step(5);
  inputs.arm = false;
  CHECK(step(5).state == RigState::safe);
  CHECK(arm().state == RigState::armed);
}

TEST(Interlock, ButtonThatIsOnForLongerThanAPressMayLastIsStuckAndDoesNothingWhenItIsLetGo) {
  begin();
  CHECK(press_for(&InterlockInputs::arm, static_cast<int>(kShort.longest_press) + 1).state == RigState::safe);
  CHECK(press_for(&InterlockInputs::arm, static_cast<int>(kShort.longest_press)).state == RigState::armed);
}

TEST(Interlock, APressActsWhenTheButtonIsLetGo) {
  begin();
  inputs.arm = true;
  CHECK(step(3).state == RigState::safe);
  inputs.arm = false;
  CHECK(step().state == RigState::armed);
  step(4);
  inputs.start = true;
  CHECK(step(3).state == RigState::armed);
  inputs.start = false;
  CHECK(step().state == RigState::running);
}

TEST(Interlock, StartIsAPressThatBeginsNoSoonerThanTheLeastTimeInArmedAndIsHeldForItsTime) {
  bring_to(RigState::armed);
  // It begins in the third cycle after the arming: too soon, however long it lasts.
  step(2);
  CHECK(press_for(&InterlockInputs::start, 4).state == RigState::armed);
  bring_to(RigState::armed);
  step(3);
  CHECK(press_for(&InterlockInputs::start, 1).state == RigState::armed);
  CHECK(press_for(&InterlockInputs::start, 2).state == RigState::running);
}

TEST(Interlock, ArmedRigThatIsNotStartedIsSafeAfterItsTimeAlsoWhileStartIsHeld) {
  for (const bool held : {false, true}) {
    bring_to(RigState::armed);
    step(4);
    inputs.start = held;
    std::uint32_t cycles = 5;
    while (step().drive) {
      ++cycles;
    }
    UNSIGNED_LONGS_EQUAL(kShort.most_armed, cycles);
    CHECK(outputs.state == RigState::safe);
    inputs.start = false;
    CHECK(step(5).state == RigState::safe);
  }
}

TEST(Interlock, StopEndsArmedAtOnceAndBringsRunningToRestAndNoneArmsWhileItIsAskedFor) {
  bring_to(RigState::armed);
  inputs.stop = true;
  CHECK(step().state == RigState::safe);
  step();
  CHECK(!arm().drive);
  bring_to(RigState::running);
  inputs.stop = true;
  CHECK(step().state == RigState::stopping);
  CHECK(outputs.drive);
  inputs.at_rest = true;
  CHECK(step().state == RigState::safe);
  CHECK(!outputs.drive);
}

TEST(Interlock, StoppingEndsAfterItsCyclesWhetherTheActuatorsRestOrNot) {
  bring_to(RigState::stopping);
  std::uint32_t cycles = 0;
  while (step().state == RigState::stopping) {
    ++cycles;
  }
  UNSIGNED_LONGS_EQUAL(kShort.most_stopping, cycles);
  CHECK(outputs.state == RigState::safe);
}

TEST(Interlock, FaultsAreKeptTogetherAndTheFirstIsNamed) {
  bring_to(RigState::running);
  interlock.step(caused(Fault::bus_down));
  interlock.step(caused(Fault::emergency_stop));
  step();
  CHECK(outputs.first == Fault::bus_down);
  CHECK(outputs.faults == (FaultSet(Fault::bus_down) | Fault::emergency_stop));
}

TEST(Interlock, WithoutAStartButtonTheArmButtonIsHeldToStart) {
  settings.start_is_arm = true;
  settings.start_hold = 4;
  settings.most_armed = 20;
  begin();
  arm();
  step(4);
  CHECK(press_for(&InterlockInputs::arm, 3).state == RigState::armed);
  bring_to(RigState::safe);
  arm();
  step(4);
  CHECK(press_for(&InterlockInputs::arm, 4).state == RigState::running);
}

TEST_GROUP(Contact) {
  Contact contact = settled(settled({}, false, false, 1), false, false, 1);

  bool follows(bool line, bool changed = false) {
    contact = settled(contact, line, changed, 3);
    return contact.on == line;
  }
};

TEST(Contact, BothEdgesAreFollowedOnlyOnceTheLineHasSaidTheSameForTheWholeTime) {
  CHECK(!contact.on);
  for (const bool line : {true, false}) {
    CHECK(!follows(line) && !follows(line) && !follows(line));
    CHECK(follows(line));
  }
}

TEST(Contact, BounceBeginsTheTimeAnewAlsoOneThatIsOverBetweenTwoLooks) {
  CHECK(!follows(true) && !follows(true) && !follows(true));
  follows(false);
  CHECK(!follows(true) && !follows(true) && !follows(true));
  CHECK(!follows(true, true) && !follows(true) && !follows(true));
  CHECK(follows(true));
}

TEST(Contact, BeginsOnSoThatNothingCountsAsSeenOffBeforeItHasSettled) {
  contact = {};
  CHECK(!follows(false) && !follows(false) && !follows(false));
  CHECK(follows(false));
}

}  // namespace hotfire::firmware
