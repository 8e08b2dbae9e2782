// SPDX-License-Identifier: Apache-2.0
#include "firmware/replay/lab_replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/files/scratch.hpp"
#include "tests/firmware/recording/recorded_lab.hpp"
#include "tests/firmware/recording/rewritten_recording.hpp"

namespace hotfire::firmware {

TEST_GROUP(LabReplay) {
  test::Scratch scratch;
  const std::string path = scratch.path("lab.hfr").string();

  std::string limits{};  ///< more lines of its image

  std::uint64_t record() const { return test_lab::record_lab(path, ~std::uint64_t{0}, limits); }

  Replay replayed() const { return test_recording::replayed(path); }

  /// Writes the recording again with `change(head, values)` made to a cycle in which it ran.
  template <class Change>
  void rewrite(Change && change) const {
    scratch.write("lab.hfr", test_recording::rewritten(path, [&](std::uint64_t cycle, std::string& bytes) {
                    if (cycle == test_lab::kRunningCycle) {
                      hal::CycleHead head;
                      std::vector<double> values((bytes.size() - sizeof head) / sizeof(double));
                      std::memcpy(&head, bytes.data(), sizeof head);
                      std::memcpy(values.data(), bytes.data() + sizeof head, values.size() * sizeof(double));
                      change(head, values);
                      std::memcpy(bytes.data(), &head, sizeof head);
                      std::memcpy(bytes.data() + sizeof head, values.data(), values.size() * sizeof(double));
                    }
                    return true;
                  }));
  }

  template <class Change>
  void differs(const char* part, Change&& change, std::uint64_t at = test_lab::kRunningCycle) {
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
  std::uint64_t started = 0;
  std::uint64_t edges = 0;
  while (reader.next(cycle)) {
    const LabInputs inputs = recorded_inputs(cycle);
    // In the first cycle both lines have just gone on, and a line that has changed is not taken for one that was on.
    CHECK_EQUAL(cycle.head.cycle > 0, inputs.rig.hydraulic_enable);
    CHECK(!inputs.rig.bus_down && !inputs.rig.bad_frame && !inputs.stop);
    stopped += inputs.rig.emergency_stop ? 1 : 0;
    pressed += inputs.arm ? 1 : 0;
    started += inputs.start ? 1 : 0;
    edges += (inputs.arm_changed ? 1 : 0) + (inputs.start_changed ? 1 : 0);
    // Nothing had come before the first cycle, whose clock shows 0.
    LONGS_EQUAL(cycle.head.cycle == 0 ? std::int64_t{1} << 62 : 0, inputs.ages_ns[0][1]);
  }
  // Pressed for five cycles, and let go in one, beside the first.
  UNSIGNED_LONGS_EQUAL(1 + 5 + 1, stopped);
  UNSIGNED_LONGS_EQUAL(3 * test_lab::kPressed, pressed);
  UNSIGNED_LONGS_EQUAL(2 * test_lab::kPressed, started);
  UNSIGNED_LONGS_EQUAL(2 * 5, edges);
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
      test_lab::kRunningCycle + 1);
}

TEST(LabReplay, LoadPressuresThatTheLabWasGivenDecideItsCyclesAgainToTheSameBits) {
  limits = test_lab::kLoadPressureLimit;
  const std::uint64_t stored = record();
  const Replay result = replayed();
  STRCMP_EQUAL("", result.difference ? result.difference->what.c_str() : "");
  UNSIGNED_LONGS_EQUAL(stored, result.proved);
  hal::RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(9, reader.header().channels.size());
  hal::RecordedCycle cycle;
  double most = 0.0;
  double before = 0.0;
  while (reader.next(cycle)) {
    const LabInputs inputs = recorded_inputs(cycle);
    LONGS_EQUAL(cycle.head.cycle == 0 ? std::int64_t{1} << 62 : 0, inputs.load_pressure_ages_ns[0]);
    // What a cycle ends with is what the next one is given.
    DOUBLES_EQUAL(before, inputs.load_pressures[0], 0.0);
    before = cycle.readings[kLoadPressure];
    most = std::max(most, std::abs(inputs.load_pressures[0]));
  }
  CHECK(most > 1e6 && most < 2e7);
  differs("recorded 2 and 0, replayed 4 and 20",
          [](hal::CycleHead&, std::vector<double>& values) { values[1 + kLoadPressureRead] = -2.00001e7; });
  differs("recorded 2 and 0, replayed 4 and 2",
          [](hal::CycleHead&, std::vector<double>& values) { values[1 + kLoadPressureAge] = 0.0051; });
  differs(
      "load_pressure of actuator 1: recorded ",
      [](hal::CycleHead&, std::vector<double>& values) { values[1 + kLoadPressure] += 1.0; }, test_lab::kRunningCycle + 1);
}

TEST(LabReplay, RecordingWithoutLoadPressuresIsWhatItWasAndOneWithoutThemIsRefused) {
  record();
  hal::RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(6, reader.header().channels.size());
  hal::RecordingHeader header = reader.header();
  header.model += test_lab::kLoadPressureLimit;
  scratch.write("lab.hfr", hal::header_text(header));
  STRCMP_CONTAINS("its channels are not those", replayed().error.c_str());
}

TEST(LabReplay, NothingBehindADroppedCycleIsClaimed) {
  test_lab::record_lab(path, 30);
  const Replay result = replayed();
  CHECK(!result.difference);
  UNSIGNED_LONGS_EQUAL(30, result.gap.value());
  UNSIGNED_LONGS_EQUAL(30, result.proved);
}

}  // namespace hotfire::firmware
