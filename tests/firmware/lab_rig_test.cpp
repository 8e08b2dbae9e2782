#include "firmware/lab_rig.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/sim/can_wire.hpp"
#include "hal/sim/gpio_board.hpp"
#include "hal/sim/manual_clock.hpp"
#include "tests/firmware/lab_settings.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

using test_lab::kPeriod;
using test_lab::kPeriodNs;
using test_lab::settings;

namespace {

using Wire = hal::sim::CanWire;
using Rig = LabRig<Wire::Node, hal::sim::GpioBoard, hal::sim::ManualClock>;

hal::GpioSettings lines() {
  hal::GpioSettings made;
  made.inputs = {{"estop"}, {"hydraulic"}, {"arm"}};
  made.outputs = {{"supply"}, {"heartbeat"}, {"fault"}};
  return made;
}

}  // namespace

TEST_GROUP(LabRig) {
  Wire wire;
  hal::sim::ManualClock clock;
  hal::sim::GpioBoard board{lines()};
  Lab lab{settings(), kPeriod};
  can::NodeIds own = can::controller_ids(can::Layout::classic, 1);
  can::NodeIds of_plant = can::plant_ids(can::Layout::classic, 1);
  Wire::Node node{wire, own.subscriptions, own.senders};
  Wire::Node plant{wire, of_plant.subscriptions, of_plant.senders};
  Rig rig{lab, node, board, clock, can::Layout::classic, kPeriodNs};
  std::uint8_t counter = 0;
  std::uint64_t commands = 0;
  hal::Command unused;

  void setup() override {
    board.drive(kEmergencyStopReleased, true);
    board.drive(kHydraulicEnabled, true);
  }

  void cycle() {
    hal::CanFrame frame;
    CHECK(can::encode(can::piston_1::kMessage, std::array{0.0, 0.0}, counter++, frame));
    plant.try_send(frame);
    rig.try_receive_command(unused);
    rig.step(unused);
    rig.try_send_reading({});
    plant.receive(clock.now_ns());
    commands += plant.mailbox(0).fresh ? 1 : 0;
    clock.advance_ns(kPeriodNs);
  }

  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      cycle();
    }
  }

  void press() {
    board.drive(kArm, true);
    cycles(2);
    board.drive(kArm, false);
    cycles(2);
  }

  bool on(LabOutput line) const { return ((board.outputs() >> line) & 1U) != 0; }
};

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

TEST(LabRig, CycleTakesNothingFromTheHeap) {
  cycle();
  press();
  press();
  const test::AllocationGuard guard;
  cycles(100);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
}

}  // namespace hotfire::firmware
