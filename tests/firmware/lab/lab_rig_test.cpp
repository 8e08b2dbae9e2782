#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

class LabOnWireGroup : public Utest, public test_lab::LabOnWire {
 public:
  LabOnWireGroup() : LabOnWire(test_lab::settings()) {}
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
  board.drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycle();
  CHECK(!on(kSupply));
  CHECK(on(kFault));
  board.drive(kEmergencyStopReleased, true);
  cycles(10);
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  CHECK(commands > sent);
}

TEST(LabRig, LinesThatCannotBeReadAreAStop) {
  cycle();
  press();
  board.set_broken(true);
  cycle();
  CHECK(lab.outputs().interlock.first == Fault::emergency_stop);
}

TEST(LabRig, CommandThatIsStillBeforeTheBusAtAFaultNeverLeaves) {
  cycle();
  press();
  wire.hold();
  cycle();
  board.drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycles(3);
  wire.release();
  plant.rearm();
  board.drive(kEmergencyStopReleased, true);
  cycles(10);
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  CHECK(commands > sent);
}

TEST(LabRig, EmergencyStopWhileTheBusIsDownAndBothReleasedLetsNoCommandOutUntilArmed) {
  cycle();
  press();
  wire.set_down(true);
  board.drive(kEmergencyStopReleased, false);
  const std::uint64_t sent = commands;
  cycles(5);
  wire.set_down(false);
  plant.rearm();
  board.drive(kEmergencyStopReleased, true);
  cycles(10);
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  UNSIGNED_LONGS_EQUAL(sent, commands);
  press();
  CHECK(commands > sent);
}

TEST(LabRig, CycleAfterTheFirstOneThatIsNotRecordedIsSafe) {
  constexpr int kSlots = 4;
  test::MemorySink disk;
  const std::lock_guard stalled(disk.gate);
  Recorder recorder(disk, 1, 1, kSlots);
  rig.watch(&recorder);
  cycle();
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
  cycle();
  press();
  press();
  const test::AllocationGuard guard;
  cycles(100);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
}

}  // namespace hotfire::firmware
