// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CppUTest/TestHarness.h>

#include <functional>

#include "firmware/lab/lab_rig.hpp"
#include "hal/sim/can_wire.hpp"
#include "hal/sim/gpio_board.hpp"
#include "hal/sim/manual_clock.hpp"
#include "tests/firmware/lab/lab_settings.hpp"

namespace hotfire::firmware::test_lab {

/// A lab on a wire, with a board of lines, beside a plant that sends what its pistons read in the frames of a layout, and
/// load pressures if the lab has a limit of them, and echoes the commands where they have room for that. Emergency stop
/// released, hydraulic supply enabled.
class LabOnWire {
 public:
  using Wire = hal::sim::CanWire;
  using Rig = LabRig<Wire::Node, hal::sim::GpioBoard, hal::sim::ManualClock>;

  explicit LabOnWire(LabSettings made, can::Layout frames = can::Layout::classic, const LabLines& lines = usual_lines(),
                     std::int64_t cycle_ns = kPeriodNs)
      : layout(frames),
        actuators(made.actuators),
        period_ns(cycle_ns),
        measures_load_pressure_(made.limits.has_load_pressure()),
        wiring(lab_gpio(lines, "board")),
        board(wiring.settings),
        lab(std::move(made), 1e-9 * static_cast<double>(cycle_ns)) {
    drive(kEmergencyStopReleased, true);
    drive(kHydraulicEnabled, true);
  }

  static LabLines usual_lines() { return {"estop", "hydraulic", "arm", "", "", "", "supply", "heartbeat", "fault"}; }

  void drive(LabInput input, bool on) { board.drive(wiring.places[input], on, clock.now_ns()); }

  /// One cycle of the loop.
  void cycle() {
    for (std::size_t i = 0; i < rig.messages(); ++i) {
      if (sends) {
        plant.try_send(reading(i, counter));
      }
    }
    ++counter;
    before_lab();
    rig.try_receive_command(unused_);
    rig.step(unused_);
    before_lines();
    rig.try_send_reading({});
    plant.receive(clock.now_ns());
    commands += plant.mailbox(0).fresh ? 1 : 0;
    if (plant.mailbox(0).fresh && hears_commands) {
      echo = plant.mailbox(0).frame.data[can::command_message(layout).crc_bits / 8];
    }
    after_cycle();
    clock.advance_ns(period_ns);
  }

  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      cycle();
    }
  }

  void press(LabInput button = kArm, int held = 2) {
    drive(button, true);
    cycles(held);
    drive(button, false);
    cycles(held);
  }

  /// What the plant says in message `which` of those that the lab listens to, under this counter.
  hal::CanFrame reading(std::size_t which, std::uint8_t number) const {
    const can::Message& message = rig.message(which);
    std::array<double, 32> values{};
    if (is_load_pressure(which)) {
      std::copy(load_pressures.begin(), load_pressures.end(), values.begin());
    } else {
      std::fill_n(values.begin(), message.signals.size(), piston);
      values[can::kEchoPlace] = can::has_echo(layout) ? echo : values[can::kEchoPlace];
    }
    hal::CanFrame frame;
    CHECK(can::encode(message, std::span(values).first(message.signals.size()), number, frame));
    return frame;
  }

  bool is_load_pressure(std::size_t which) const { return which == can::reading_messages(layout, actuators); }

  /// Armed and started, with some cycles of the profile behind it.
  void run() {
    cycles(3);
    press();
    press();
    cycles(5);
    CHECK(lab.outputs().interlock.state == RigState::running);
  }

  bool on(LabOutput line) const { return ((board.outputs() >> line) & 1U) != 0; }

 private:
  hal::Command unused_;

 public:
  can::Layout layout;
  std::size_t actuators;
  std::int64_t period_ns;

 private:
  bool measures_load_pressure_;
  can::NodeIds own_ = can::controller_ids(layout, actuators, measures_load_pressure_);
  can::NodeIds of_plant_ = can::plant_ids(layout, actuators, {.load_pressure = true});

 public:
  std::uint8_t counter = 0;  ///< of the readings of the next cycle
  std::uint8_t echo = 0;     ///< counter of the newest command that the plant has
  bool sends = true;
  bool hears_commands = true;
  Wire wire;
  hal::sim::ManualClock clock;
  LabGpio wiring;
  hal::sim::GpioBoard board;
  Lab lab;
  Wire::Node node{wire, own_.subscriptions, own_.senders};
  Wire::Node plant{wire, of_plant_.subscriptions, of_plant_.senders};
  Rig rig{lab, node, board, wiring, clock, layout, period_ns};
  double piston = 0.0;                         ///< what both of its readings say [m]
  PerActuator load_pressures{};                ///< [Pa]
  std::uint64_t commands = 0;                  ///< that have reached the plant
  std::function<void()> before_lab = [] {};    ///< after the plant has sent
  std::function<void()> before_lines = [] {};  ///< when it is decided what they say
  std::function<void()> after_cycle = [] {};   ///< before the clock goes on
};

}  // namespace hotfire::firmware::test_lab
