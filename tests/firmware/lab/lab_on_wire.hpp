#pragma once

#include <CppUTest/TestHarness.h>

#include <functional>

#include "firmware/lab/lab_rig.hpp"
#include "hal/sim/can_wire.hpp"
#include "hal/sim/gpio_board.hpp"
#include "hal/sim/manual_clock.hpp"
#include "tests/firmware/lab/lab_settings.hpp"

namespace hotfire::firmware::test_lab {

/// A lab of one actuator on a wire, with a board of lines, beside a node that sends what its pistons read. Emergency stop
/// released, hydraulic supply enabled.
class LabOnWire {
 public:
  using Wire = hal::sim::CanWire;
  using Rig = LabRig<Wire::Node, hal::sim::GpioBoard, hal::sim::ManualClock>;

  explicit LabOnWire(LabSettings made) : lab(std::move(made), kPeriod) {
    board.drive(kEmergencyStopReleased, true);
    board.drive(kHydraulicEnabled, true);
  }

  /// One cycle of the loop.
  void cycle() {
    hal::CanFrame frame;
    CHECK(can::encode(can::piston_1::kMessage, std::array{piston, piston}, counter_++, frame));
    plant.try_send(frame);
    rig.try_receive_command(unused_);
    rig.step(unused_);
    rig.try_send_reading({});
    plant.receive(clock.now_ns());
    commands += plant.mailbox(0).fresh ? 1 : 0;
    after_cycle();
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

 private:
  static hal::GpioSettings lines() {
    hal::GpioSettings made;
    made.inputs = {{"estop"}, {"hydraulic"}, {"arm"}};
    made.outputs = {{"supply"}, {"heartbeat"}, {"fault"}};
    return made;
  }

  can::NodeIds own_ = can::controller_ids(can::Layout::classic, 1);
  can::NodeIds of_plant_ = can::plant_ids(can::Layout::classic, 1);
  std::uint8_t counter_ = 0;
  hal::Command unused_;

 public:
  Wire wire;
  hal::sim::ManualClock clock;
  hal::sim::GpioBoard board{lines()};
  Lab lab;
  Wire::Node node{wire, own_.subscriptions, own_.senders};
  Wire::Node plant{wire, of_plant_.subscriptions, of_plant_.senders};
  Rig rig{lab, node, board, clock, can::Layout::classic, kPeriodNs};
  double piston = 0.0;                        ///< what both of its readings say [m]
  std::uint64_t commands = 0;                 ///< that have reached the plant
  std::function<void()> after_cycle = [] {};  ///< before the clock goes on
};

}  // namespace hotfire::firmware::test_lab
