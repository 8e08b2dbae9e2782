// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "tests/firmware/lab/lab_on_wire.hpp"

namespace hotfire::firmware {

namespace {

LabLines lines_that_read_back() {
  LabLines lines = test_lab::LabOnWire::usual_lines();
  lines.supply_read_back = "contactor";
  lines.fault_read_back = "lamp";
  return lines;
}

LabSettings settings_that_read_back() {
  LabSettings made = test_lab::settings();
  made.limits.read_back_cycles = 5;
  return made;
}

class ReadBackGroup : public Utest, public test_lab::LabOnWire {
 public:
  ReadBackGroup() : LabOnWire(settings_that_read_back(), can::Layout::classic, lines_that_read_back()) {
    rig.ask_to_stop_when(asked_);
    after_cycle = [this] {
      drive(kSupplyReadBack, welded || (on(kSupply) && !stuck));
      drive(kFaultReadBack, on(kFault) != lamp_is_wrong);
    };
  }

  /// Asks the program to end and goes on until it may; returns for how many cycles its supply was off by then.
  int end_program() {
    asked_ = true;
    int undriven = 0;
    for (int i = 0; i < 3000 && !rig.ended(); ++i) {
      cycle();
      undriven += on(kSupply) ? 0 : 1;
    }
    return undriven;
  }

  bool welded = false;
  bool stuck = false;
  bool lamp_is_wrong = false;

 private:
  std::atomic<bool> asked_{false};
};

}  // namespace

TEST_GROUP_BASE(LabReadBack, ReadBackGroup){};

TEST(LabReadBack, LinesThatFollowAreNoFault) {
  cycles(20);
  press();
  cycles(20);
  CHECK(on(kSupply));
  drive(kEmergencyStopReleased, false);
  cycles(20);
  CHECK(lab.outputs().interlock.faults == FaultSet(Fault::emergency_stop));
}

TEST(LabReadBack, ContactorThatDoesNotPullInIsAFaultWhileDriven) {
  stuck = true;
  cycles(20);
  press();
  CHECK(on(kSupply));
  cycles(10);
  CHECK(!on(kSupply));
  CHECK(lab.outputs().interlock.first == Fault::supply_read_back);
}

TEST(LabReadBack, ContactorThatIsWeldedIsAFaultOfASafeRigAndForbidsArming) {
  cycles(20);
  welded = true;
  cycles(10);
  CHECK(on(kFault));
  CHECK(lab.outputs().interlock.first == Fault::supply_read_back);
  press();
  CHECK(!on(kSupply));
  welded = false;
  cycles(2);
  press();
  CHECK(on(kSupply));
}

TEST(LabReadBack, ContactorThatWeldsDuringTheProfileIsFoundBeforeTheProgramEnds) {
  cycles(20);
  LabOnWire::run();
  welded = true;
  end_program();
  CHECK(rig.ended());
  CHECK(lab.outputs().interlock.first == Fault::supply_read_back);
  CHECK(on(kFault));
}

TEST(LabReadBack, SupplyThatFollowsEndsTheProgramAtOnce) {
  cycles(20);
  LabOnWire::run();
  const int undriven = end_program();
  CHECK(lab.outputs().interlock.faults == FaultSet());
  CHECK(undriven <= 3);
}

TEST(LabReadBack, PressWhileTheSupplyStillReadsOnArmsNothing) {
  cycles(20);
  press();
  CHECK(on(kSupply));
  welded = true;
  drive(kEmergencyStopReleased, false);
  cycle();
  drive(kEmergencyStopReleased, true);
  // Sooner than the read-back is a fault.
  press(kArm, 1);
  CHECK(!on(kSupply));
  CHECK(!lab.outputs().interlock.faults.has(Fault::supply_read_back));
  cycles(20);
  CHECK(lab.outputs().interlock.faults.has(Fault::supply_read_back));
}

TEST(LabReadBack, FaultLineThatDoesNotFollowIsAFault) {
  cycles(20);
  lamp_is_wrong = true;
  cycles(10);
  CHECK(lab.outputs().interlock.first == Fault::fault_read_back);
}

}  // namespace hotfire::firmware
