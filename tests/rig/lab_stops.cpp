// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/lab_stops.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

#include "firmware/lab/lab_recorder.hpp"
#include "hal/recording/reader.hpp"

namespace hotfire::test {
namespace {

using firmware::Fault;
using firmware::LabInputs;
using firmware::RigState;
using Head = hal::CycleHead;

/// A cycle: what the lab was given, and what it commanded [m].
struct Given {
  const LabInputs& inputs;
  double command;
};

/// Whether a cycle shows the fault, by the limits themselves and not by the code under test. A position error has to last.
bool shows(Fault fault, const Given& given, std::int64_t age_limit_ns) {
  const LabInputs& in = given.inputs;
  const auto& [first, second] = in.readings[0];
  switch (fault) {
    case Fault::stale_command:
      return in.rig.command_age_ns > age_limit_ns;
    case Fault::stale_sensor:
      return std::max({in.ages_ns[0][0], in.ages_ns[0][1], in.load_pressure_ages_ns[0]}) > age_limit_ns;
    case Fault::out_of_range:
      return std::abs(first) > 0.15;
    case Fault::readings_disagree:
      return std::abs(first - second) > 0.001;
    case Fault::bad_frame:
      return in.rig.bad_frame;
    case Fault::second_sender:
      return in.rig.second_sender;
    case Fault::not_authentic:
      return in.rig.not_authentic;
    case Fault::command_not_answered:
      return in.rig.command_not_answered;
    case Fault::bus_off:
      return in.rig.bus_off;
    case Fault::bus_down:
      return in.rig.bus_down;
    case Fault::transmit_queue_full:
      return in.rig.transmit_queue_full;
    case Fault::emergency_stop:
      return in.rig.emergency_stop;
    case Fault::hydraulic_enable_lost:
      return !in.rig.hydraulic_enable;
    case Fault::overrun:
      return in.rig.overrun;
    case Fault::limit:
      return std::abs(first) > 0.06;
    case Fault::recorder_full:
      return in.rig.dropped_recording;
    case Fault::position_error:
      return std::abs(given.command - 0.5 * (first + second)) > 0.005;
    case Fault::take_back_refused:
      return in.rig.take_back_refused;
    case Fault::supply_read_back:
      return in.rig.supply_reads_other;
    case Fault::fault_read_back:
      return in.rig.fault_line_reads_other;
    case Fault::load_pressure:
      return std::abs(in.load_pressures[0]) > 2e7;
    case Fault::speed:           // is of many cycles
    case Fault::not_finite:      // is never handed on
    case Fault::heartbeat_lost:  // is a plant's
      break;
  }
  return false;
}

constexpr std::size_t kLastCycles = 64;
constexpr double kPistonPerCommand = 0.5;

}  // namespace

LabRecord read_lab_record(const std::string& path, const LabLimits& limits) {
  LabRecord result;
  hal::RecordingReader reader(path);
  STRCMP_EQUAL("", reader.error().c_str());
  hal::RecordedCycle cycle;
  firmware::FaultCounts shown_since{};
  Stop now;
  // Of the cycles that were run: what lasts is counted in these.
  std::uint64_t run = 0;
  while (reader.next(cycle)) {
    ++run;
    const auto state = static_cast<RigState>((cycle.head.flags >> Head::kStateShift) & 0xff);
    const LabInputs inputs = firmware::recorded_inputs(cycle);
    const bool drives = state != RigState::safe && state != RigState::faulted;
    if (drives || !now.drove.empty()) {
      for (const firmware::FaultText& text : firmware::kFaults) {
        std::uint64_t& since = shown_since[static_cast<std::size_t>(text.fault)];
        since = !shows(text.fault, {inputs, kPistonPerCommand * cycle.commands[0]}, limits.age_ns) ? 0
                : since == 0                                                                       ? run
                                                                                                   : since;
      }
    }
    if (drives) {
      result.commands += (cycle.head.flags & Head::kLost) == 0 ? 1 : 0;
      now.drove.push_back(cycle.head.woken_ns);
      if (now.drove.size() > kLastCycles) {
        now.drove.erase(now.drove.begin());
      }
    } else if (!now.drove.empty()) {
      if (state == RigState::faulted) {
        now.fault = static_cast<Fault>((cycle.head.flags >> Head::kFaultShift) & 0xff);
        now.seen = shown_since[static_cast<std::size_t>(now.fault)] +
                   (now.fault == Fault::position_error ? limits.position_error_cycles : 0);
        now.safe = run;
        result.stops.push_back(now);
      }
      now = {};
      shown_since = {};
    }
  }
  return result;
}

}  // namespace hotfire::test
