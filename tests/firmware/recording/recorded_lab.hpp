// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "firmware/lab/lab_image.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "firmware/session/recording_session.hpp"
#include "tests/firmware/lab/lab_on_wire.hpp"

namespace hotfire::firmware::test_lab {

inline const std::string kRecordedLabImage =
    "schema 1\ntopology lab\nactuators 1\npiston_per_command 0.5\ncurrent_per_command 0.1\ncurrent_per_error 0.3\n"
    "current_limit 0.02\napproach_rate 1\nrest_speed 0.01\nstopping_time 0.05\nlimits.command_age 0.005\n"
    "limits.reading_age 0.005\nlimits.lowest_reading -0.15\nlimits.highest_reading 0.15\nlimits.disagreement 0.001\n"
    "limits.lowest_position -0.06\nlimits.highest_position 0.06\nlimits.command_rate 100\nlimits.position_error 0.05\n"
    "limits.speed 1000\nlimits.speed_time 0.01\nlimits.read_back_time 0.1\ninterlock.debounce 0.005\n"
    "interlock.start_hold 0\ninterlock.longest_press 10\ninterlock.least_armed 1\ninterlock.arming_timeout 60\n"
    "limits.position_error_time 0.5\nlimits.overruns 0\nline.emergency_stop estop\nline.hydraulic_enable hydraulic\n"
    "line.arm arm\nline.start start\nline.supply supply\nline.heartbeat heartbeat\nline.fault fault\nsegment.0.duration "
    "0.1\n"
    "segment.0.from 0\nsegment.0.to 0\nsegment.0.amplitude 0.01\nsegment.0.frequency 10\nsegment.0.last_frequency 20\n";

/// Of a lab that measures load pressures, and what an actuator that lags has of them [Pa/m]: half the limit at the most.
inline const std::string kLoadPressureLimit = "limits.load_pressure 2e7\n";
inline constexpr double kPressurePerLag = 1e9;

/// For so many cycles a button is pressed, and then off.
inline constexpr int kPressed = 10;
/// From the arming on, before a start may begin.
inline constexpr int kArmed = 1000;
/// A cycle in which the lab runs.
inline constexpr std::uint64_t kRunningCycle = 10 + 2 * kPressed + kArmed + 2 * kPressed + 10;

/// Records a lab to a file. It is armed, run, stopped by an emergency stop, armed and run again to the end of its profile,
/// and is pressed once more when its readings are out of range. Cycle `gap` is left out. `limits`: more lines of its image.
/// Returns how many cycles are in the file.
inline std::uint64_t record_lab(const std::string& path, std::uint64_t gap = ~std::uint64_t{0},
                                const std::string& limits = "") {
  LabImage image = parse_lab_image(kRecordedLabImage + limits, "image", kPeriod);
  const bool has_load_pressure = image.settings->limits.has_load_pressure();
  LabOnWire bench(std::move(*image.settings), can::Layout::classic, image.lines);
  LabOptions options;
  options.recording = path;
  options.overwrite = true;  // a test may record again
  RecordedPlant plant;
  plant.topology = kLabTopology;
  plant.input = {"command", "rad"};
  plant.channels = lab_channels(has_load_pressure);
  plant.start.assign(plant.channels.size(), 0.0);
  plant.image = image.text;
  RecordingSession session(options, plant);
  CHECK(!session.start());
  LabRecorder<LabOnWire::Rig> recorder(session.recorder(), bench.rig);
  hal::Fnv1a hash;
  hal::CycleHead head;
  bench.after_cycle = [&] {
    bench.rig.add_to(hash);
    head.hash = hash.value();
    if (head.cycle != gap) {
      recorder.record(head, {}, bench.rig.measured());
    }
    ++head.cycle;
    // An actuator that lags.
    bench.load_pressures[0] = kPressurePerLag * (0.5 * bench.lab.outputs().commands[0] - bench.piston);
    bench.piston += 0.2 * (0.5 * bench.lab.outputs().commands[0] - bench.piston);
  };
  bench.piston = 0.004;
  bench.cycles(10);
  const auto arm_and_start = [&] {
    bench.press(kArm, kPressed);
    bench.cycles(kArmed);
    bench.press(kStart, kPressed);
  };
  arm_and_start();
  bench.cycles(30);
  bench.drive(kEmergencyStopReleased, false);
  bench.cycles(5);
  bench.drive(kEmergencyStopReleased, true);
  bench.cycles(2);
  arm_and_start();
  bench.cycles(300);
  CHECK(bench.lab.completed());
  bench.piston = 0.2;
  bench.press(kArm, kPressed);
  recorder.finish();
  return session.close().stored;
}

}  // namespace hotfire::firmware::test_lab
