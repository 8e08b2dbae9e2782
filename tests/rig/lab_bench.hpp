// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "firmware/can/codec.hpp"
#include "firmware/interlock/interlock.hpp"
#include "hal/can.hpp"

namespace hotfire::test {

/// Runs a line of shell with the helpers of the virtual rig at hand; fails the test if that fails.
void shell(const std::string& command);

/// Makes the bank `rig`, with the lines that `Line` names.
void bank_up();
/// Takes it away, and every bus.
void bank_down();

/// Waits, 20 s at most, until it is so; fails the test with `what` if it never is.
void wait_until(const std::string& what, const std::function<bool()>& is_so);

/// What is on the bus beside the lab: an actuator that goes where it is told, with its two potentiometers, which answer
/// SYNC, and with its load pressure if it is told to; it keeps count of the commands, and can be made to go wrong: `doubled`
/// is a second node that says after every reading, with its counter, that the piston stands at 0; `surplus` is one that says
/// so with the next counter, on which the first one goes on.
class SensorNode {
 public:
  enum class Mode : std::uint8_t { good, silent, damaged, jammed, doubled, surplus };

  SensorNode();
  ~SensorNode();
  SensorNode(const SensorNode&) = delete;
  SensorNode& operator=(const SensorNode&) = delete;

  /// Hands a report of the controller to everyone on the bus, as a driver does. False if the bus is down.
  bool report_bus_off() const;
  /// A command that the lab has not sent.
  void send_command() const;

  std::atomic<Mode> mode{Mode::good};
  std::atomic<double> offset{0.0};         ///< of both readings [m]
  std::atomic<double> second_offset{0.0};  ///< of the second one
  std::atomic<bool> sends_load_pressure{false};
  std::atomic<double> load_pressure{0.0};  ///< [Pa]
  std::atomic<std::uint64_t> commands{0};
  std::atomic<std::uint64_t> heartbeats{0};
  std::atomic<std::uint64_t> commands_when_not_driving{0};  ///< that came after a heartbeat which said safe or faulted
  std::atomic<std::uint64_t> quiet{0};                      ///< times that nothing had come for a while
  std::atomic<firmware::RigState> state{firmware::RigState::safe};

 private:
  void serve();
  void take(const hal::CanFrame& frame);
  void answer();
  void send(const hal::CanFrame& frame) const;

  int socket_;
  std::atomic<bool> ended_{false};
  double position_ = 0.0;
  std::uint8_t counter_ = 0;
  std::thread thread_;
};

/// `hotfire-rt lab` as a process, on can0 and the bank `rig`, recorded.
class LabProgram {
 public:
  static constexpr const char* kRecording = "/tmp/lab.hfr";

  /// `changes`: lines of the image that take the place of the usual ones. `options` are added.
  explicit LabProgram(const std::string& changes = "", const std::string& options = "");
  ~LabProgram();
  LabProgram(const LabProgram&) = delete;
  LabProgram& operator=(const LabProgram&) = delete;

  int process() const { return process_; }
  void signal(int number) const;
  /// Changes a number in the memory of the running program, wherever it has it, as memory that goes bad would.
  void change_memory(double from, double to) const;
  /// Waits for its end; returns the exit status.
  int wait();
  std::string output() const;

 private:
  int process_ = -1;
};

enum Line : std::uint8_t {
  kStopLine,
  kHydraulicLine,
  kArmLine,
  kSupplyLine,
  kHeartbeatLine,
  kFaultLine,
  kStartLine,
  kContactorLine
};

/// What a line carries, and drives an input.
bool carries(Line line);
void pull(Line line, bool up);
/// Waits for so many changes of the heartbeat line, which changes every cycle.
void wait_for_beats(int beats);
/// Presses and releases a button, each for some cycles.
void press(Line button = kArmLine);

}  // namespace hotfire::test
