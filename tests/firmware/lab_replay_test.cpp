#include "firmware/lab_replay.hpp"

#include <fstream>
#include <iterator>
#include <memory>

#include "firmware/lab_recorder.hpp"
#include "firmware/recording_session.hpp"
#include "tests/files/scratch.hpp"
#include "tests/firmware/lab_on_wire.hpp"

namespace hotfire::firmware {

namespace {

const std::string kImage =
    "schema 1\ntopology lab\nactuators 1\npiston_per_command 0.5\ncurrent_per_command 0.1\ncurrent_per_error 0.3\n"
    "current_limit 0.02\napproach_rate 1\nrest_speed 0.01\nstopping_time 0.05\nlimits.command_age 0.005\n"
    "limits.reading_age 0.005\nlimits.lowest_reading -0.15\nlimits.highest_reading 0.15\nlimits.disagreement 0.001\n"
    "limits.lowest_position -0.06\nlimits.highest_position 0.06\nlimits.command_rate 100\nlimits.position_error 0.05\n"
    "limits.position_error_time 0.5\nlimits.overruns 0\nline.emergency_stop estop\nline.hydraulic_enable hydraulic\n"
    "line.arm arm\nline.supply supply\nline.heartbeat heartbeat\nline.fault fault\nsegment.0.duration 0.1\n"
    "segment.0.from 0\nsegment.0.to 0\nsegment.0.amplitude 0.01\nsegment.0.frequency 10\nsegment.0.last_frequency 20\n";

}  // namespace

TEST_GROUP(LabReplay) {
  test::Scratch scratch;
  const std::string path = scratch.path("lab.hfr").string();

  /// Records a lab that is armed, run, stopped by an emergency stop, armed and run again to the end of its profile, and is
  /// pressed once more when its readings are out of range. `cycles` in a row are dropped from `gap` on.
  std::uint64_t record(std::uint64_t gap = ~std::uint64_t{0}) const {
    LabImage image = parse_lab_image(kImage, "image", test_lab::kPeriod);
    test_lab::LabOnWire bench(std::move(*image.settings));
    Options options;
    options.recording = path;
    RecordedPlant plant;
    plant.topology = kLabTopology;
    plant.input = {"command", "rad"};
    plant.channels.assign(kLabChannels.begin(), kLabChannels.end());
    plant.start.assign(kLabChannels.size(), 0.0);
    plant.image = kImage;
    RecordingSession session(options, plant);
    CHECK(!session.start());
    LabRecorder<test_lab::LabOnWire::Rig> recorder(session.recorder(), bench.rig);
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
      bench.piston += 0.2 * (0.5 * bench.lab.outputs().commands[0] - bench.piston);
    };
    bench.piston = 0.004;
    bench.cycles(5);
    bench.press();
    bench.press();
    bench.cycles(30);
    bench.board.drive(kEmergencyStopReleased, false);
    bench.cycles(5);
    bench.board.drive(kEmergencyStopReleased, true);
    bench.press();
    bench.press();
    bench.cycles(300);
    CHECK(bench.lab.completed());
    bench.piston = 0.2;
    bench.press();
    return session.close().stored;
  }

  Replay replayed() const {
    hal::RecordingReader reader(path);
    STRCMP_EQUAL("", reader.error().c_str());
    return replay(reader);
  }

  /// Writes the recording again with the bytes of cycle 20 changed.
  template <class Change>
  void rewrite(Change && change) const {
    hal::RecordingReader reader(path);
    std::ifstream file(path, std::ios::binary);
    const std::string old{std::istreambuf_iterator<char>(file), {}};
    std::string blocks;
    hal::RecordedCycle cycle;
    while (reader.next(cycle)) {
      std::vector<double> values(cycle.commands.begin(), cycle.commands.end());
      values.insert(values.end(), cycle.readings.begin(), cycle.readings.end());
      if (cycle.head.cycle == 20) {
        change(cycle.head, values);
      }
      std::string one(reinterpret_cast<const char*>(&cycle.head), sizeof cycle.head);
      one.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
      hal::BlockHead head;
      head.cycles = 1;
      head.checksum = head.checksum_with(std::as_bytes(std::span(one)));
      blocks.append(reinterpret_cast<const char*>(&head), sizeof head).append(one);
    }
    scratch.write("lab.hfr", old.substr(0, old.find("\ncycles\n") + 8) + blocks);
  }

  template <class Change>
  void differs(const char* part, Change&& change, std::uint64_t at = 20) {
    record();
    rewrite(change);
    const Replay result = replayed();
    CHECK(result.difference.has_value());
    UNSIGNED_LONGS_EQUAL(at, result.difference->cycle);
    STRCMP_CONTAINS(part, result.difference->what.c_str());
  }
};

TEST(LabReplay, EveryCycleIsDecidedAgainToTheSameBits) {
  const std::uint64_t stored = record();
  const Replay result = replayed();
  STRCMP_EQUAL("", result.error.c_str());
  STRCMP_EQUAL("", result.difference ? result.difference->what.c_str() : "");
  UNSIGNED_LONGS_EQUAL(stored, result.proved);
}

TEST(LabReplay, WhatTheLabSawIsTakenOutAsItWasPutIn) {
  record();
  hal::RecordingReader reader(path);
  hal::RecordedCycle cycle;
  std::uint64_t stopped = 0;
  std::uint64_t pressed = 0;
  while (reader.next(cycle)) {
    const LabInputs inputs = recorded_inputs(cycle.head, cycle.readings);
    CHECK(inputs.rig.hydraulic_enable);
    CHECK(!inputs.rig.bus_down && !inputs.rig.bad_frame && !inputs.stop);
    CHECK_EQUAL(inputs.arm, inputs.start);
    stopped += inputs.rig.emergency_stop ? 1 : 0;
    pressed += inputs.arm ? 1 : 0;
    // Nothing had come before the first cycle, whose clock shows 0.
    LONGS_EQUAL(cycle.head.cycle == 0 ? std::int64_t{1} << 62 : 0, inputs.ages_ns[0]);
  }
  UNSIGNED_LONGS_EQUAL(5, stopped);
  UNSIGNED_LONGS_EQUAL(10, pressed);
}

TEST(LabReplay, OneThingThatIsNotAsTheLogicWouldHaveItIsNamed) {
  differs("command of actuator 1: recorded ",
          [](hal::CycleHead&, std::vector<double>& values) { values[0] = std::nextafter(values[0], 1.0); });
  differs("servovalve_current of actuator 1: recorded ", [](hal::CycleHead&, std::vector<double>& values) {
    values[1 + kServovalveCurrent] = std::nextafter(values[1 + kServovalveCurrent], 1.0);
  });
  differs("state and first fault: recorded 4 and 0, replayed 2 and 0",
          [](hal::CycleHead& head, std::vector<double>&) { head.flags ^= hal::CycleHead::lab_flags(2 ^ 4, 0); });
  differs("recorded 2 and 0, replayed 4 and 9", [](hal::CycleHead& head, std::vector<double>&) {
    head.flags ^= std::uint64_t{1} << (hal::CycleHead::kInputsShift + 4);
  });
  differs("recorded 2 and 0, replayed 4 and 3",
          [](hal::CycleHead&, std::vector<double>& values) { values[1 + kPistonB] = 0.151; });
  // Where the piston was at its end, the next cycle knows.
  differs(
      "piston of actuator 1: recorded ", [](hal::CycleHead&, std::vector<double>& values) { values[1 + kPiston] = 0.0; },
      21);
}

TEST(LabReplay, NothingBehindADroppedCycleIsClaimed) {
  record(30);
  const Replay result = replayed();
  CHECK(!result.difference);
  UNSIGNED_LONGS_EQUAL(30, result.gap.value());
  UNSIGNED_LONGS_EQUAL(30, result.proved);
}

}  // namespace hotfire::firmware
