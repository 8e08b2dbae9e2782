// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

class LabOnWireGroup : public Utest, public test_lab::LabOnWire {
 public:
  LabOnWireGroup() : LabOnWire(test_lab::settings()) {}

  /// No command leaves before the operator has acknowledged and armed.
  void expect_no_command_until_armed(std::uint64_t sent) {
    plant.rearm();
    cycles(10);
    UNSIGNED_LONGS_EQUAL(sent, commands);
    press();
    UNSIGNED_LONGS_EQUAL(sent, commands);
    press();
    CHECK(commands > sent);
  }
};

}  // namespace

TEST_GROUP_BASE(LabRig, LabOnWireGroup){};

TEST(LabRig, LinesFollowTheInterlockAndNoCommandIsSentUntilArmed) {
  cycles(5);
  UNSIGNED_LONGS_EQUAL(0, commands);
  CHECK(!on(kSupply));
  press();
  CHECK(on(kSupply));
  CHECK(commands > 0);
  drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycle();
  CHECK(!on(kSupply));
  CHECK(on(kFault));
  drive(kEmergencyStopReleased, true);
  cycles(10);
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  CHECK(commands > sent);
}

TEST(LabRig, LinesThatCannotBeReadAreAStop) {
  cycles(2);
  press();
  board.set_broken(true);
  cycle();
  CHECK(lab.outputs().interlock.first == Fault::emergency_stop);
}

TEST(LabRig, PressThatBeganWhileTheLinesCouldNotBeReadArmsNothing) {
  cycles(2);
  press();
  CHECK(on(kSupply));
  board.set_broken(true);
  cycles(2);
  drive(kArm, true);
  cycle();
  board.set_broken(false);
  cycles(3);
  drive(kArm, false);
  cycles(3);
  CHECK(!on(kSupply));
  press();
  CHECK(on(kSupply));
}

TEST(LabRig, CommandThatIsStillBeforeTheBusAtAFaultNeverLeaves) {
  cycles(2);
  press();
  wire.hold();
  cycle();
  drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycles(3);
  wire.release();
  drive(kEmergencyStopReleased, true);
  expect_no_command_until_armed(sent);
}

TEST(LabRig, EmergencyStopWhileTheBusIsDownAndBothReleasedLetsNoCommandOutUntilArmed) {
  cycles(2);
  press();
  wire.set_down(true);
  drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycles(5);
  wire.set_down(false);
  drive(kEmergencyStopReleased, true);
  expect_no_command_until_armed(sent);
}

TEST(LabRig, CycleAfterTheFirstOneThatIsNotRecordedIsSafe) {
  constexpr int kSlots = 4;
  test::MemorySink disk;
  const std::lock_guard stalled(disk.gate);
  Recorder recorder(disk, 1, 1, kSlots);
  rig.watch(&recorder);
  cycles(2);
  press();
  const std::array<double, 1> value{};
  while (!recorder.dropping()) {
    CHECK(on(kSupply));
    recorder.record({}, value, value);
  }
  const std::uint64_t sent = commands;
  cycle();
  CHECK(lab.outputs().interlock.first == Fault::recorder_full);
  CHECK(!on(kSupply));
  UNSIGNED_LONGS_EQUAL(sent, commands);
}

TEST(LabRig, CycleTakesNothingFromTheHeap) {
  cycles(2);
  press();
  press();
  const test::AllocationGuard guard;
  cycles(100);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
}

TEST(LabRig, StopThatComesAndGoesBetweenTwoCyclesIsAStop) {
  cycles(2);
  press();
  for (const LabInput line : {kEmergencyStopReleased, kHydraulicEnabled}) {
    press();
    CHECK(on(kSupply));
    drive(line, false);
    drive(line, true);
    cycle();
    CHECK(!on(kSupply));
    CHECK(lab.outputs().interlock.first ==
          (line == kEmergencyStopReleased ? Fault::emergency_stop : Fault::hydraulic_enable_lost));
    press();
  }
}

TEST(LabRig, MoreEdgesThanTheKernelKeepsAreTakenForAStop) {
  cycles(2);
  press();
  CHECK(on(kSupply));
  // An even number, of a line that is no stop.
  for (std::size_t i = 0; i < hal::sim::GpioBoard::kMaxEdges + 2; ++i) {
    drive(kArm, i % 2 == 0);
  }
  cycle();
  CHECK(lab.outputs().interlock.first == Fault::emergency_stop);
  CHECK(!on(kSupply));
}

TEST(LabRig, FaultWhileStoppingIsTheOneThatIsNamed) {
  cycles(2);
  press();
  press();
  piston = 0.0;
  std::atomic<bool> asked{false};
  rig.ask_to_stop_when(asked);
  asked = true;
  cycle();
  CHECK(lab.outputs().interlock.state == RigState::stopping);
  CHECK(!rig.ended());
  drive(kEmergencyStopReleased, false);
  cycle();
  CHECK(lab.outputs().interlock.first == Fault::emergency_stop);
  CHECK(!on(kSupply));
  cycles(1);
  CHECK(rig.ended());
}

TEST(LabRig, EndOfItsCyclesStopsWhatRunsThroughTheInterlock) {
  rig.stop_after(20);
  cycles(2);
  press();
  press();
  for (int i = 0; i < 30 && lab.outputs().interlock.state == RigState::running; ++i) {
    cycle();
  }
  CHECK(lab.outputs().interlock.state == RigState::stopping);
  CHECK(on(kSupply));
  for (int i = 0; i < 200 && on(kSupply); ++i) {
    CHECK(!rig.ended());
    cycle();
  }
  // The lines that were set are read back in the cycle after.
  CHECK(!rig.ended());
  cycle();
  CHECK(rig.ended());
  CHECK(lab.outputs().interlock.state == RigState::safe);
}

TEST(LabRig, LinesAreDroppedWhateverTheInterlockSays) {
  cycles(2);
  press();
  CHECK(on(kSupply));
  CHECK(rig.drop_lines());
  UNSIGNED_LONGS_EQUAL(0, board.outputs());
  board.set_broken(true);
  CHECK(!rig.drop_lines());
}

TEST(LabRig, TakeBackThatTheKernelRefusesIsAFaultThatIsHeldUntilItIsGranted) {
  cycles(2);
  press();
  wire.hold();
  wire.set_stop_refused(true);
  cycle();
  const std::uint64_t sent = commands;
  std::atomic<bool> asked{true};
  rig.ask_to_stop_when(asked);
  cycles(2);
  // It was not driven any more for any fault: the stop was asked for.
  CHECK(!on(kSupply));
  for (int i = 0; i < 3; ++i) {
    CHECK(!rig.ended());
    cycle();
  }
  CHECK(lab.outputs().interlock.first == Fault::take_back_refused);
  CHECK(on(kFault));
  CHECK(rig.may_have_command_before_bus());
  asked = false;
  press();
  CHECK(!on(kSupply));
  cycles(200);
  CHECK(on(kFault));
  wire.set_stop_refused(false);
  // Asked again within a tenth of a second.
  cycles(100);
  wire.release();
  expect_no_command_until_armed(sent);
}

TEST(LabRig, EndOfTheProgramWaitsASecondForACommandThatTheKernelKeeps) {
  cycles(2);
  press();
  wire.hold();
  wire.set_stop_refused(true);
  cycle();
  std::atomic<bool> asked{true};
  rig.ask_to_stop_when(asked);
  int waited = 0;
  for (; waited < 3000 && !rig.ended(); ++waited) {
    CHECK(waited < 4 || on(kFault));
    cycle();
  }
  // A second, and the cycles in which it was found.
  CHECK(waited >= 1000 && waited < 1010);
  CHECK(lab.outputs().interlock.first == Fault::take_back_refused);
}

TEST(LabRig, LinesThatCannotBeSetInTheLastCycleAreSetAgainBeforeTheProgramEnds) {
  std::atomic<bool> asked{false};
  rig.ask_to_stop_when(asked);
  LabOnWire::run();
  asked = true;
  bool broken = true;
  before_lines = [&] { board.set_broken(broken && !lab.outputs().interlock.drive); };
  for (int i = 0; i < 300 && lab.outputs().interlock.drive; ++i) {
    cycle();
  }
  cycles(5);
  CHECK(on(kSupply));
  CHECK(!rig.ended());
  broken = false;
  cycles(3);
  CHECK(!on(kSupply));
  CHECK(rig.ended());
}

TEST(LabRig, EndOfTheProgramWaitsASecondForLinesThatCannotBeSet) {
  std::atomic<bool> asked{true};
  rig.ask_to_stop_when(asked);
  board.set_broken(true);
  int waited = 0;
  for (; waited < 3000 && !rig.ended(); ++waited) {
    cycle();
  }
  CHECK(waited >= 1000 && waited < 1010);
  CHECK(!rig.drop_lines());
}

}  // namespace hotfire::firmware
