// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "hal/recording/header.hpp"
#include "hal/recording/reader.hpp"
#include "tests/files/scratch.hpp"
#include "tests/firmware/recording/recorded_lab.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/firmware/recording/rewritten_recording.hpp"
#include "tools/files/record/record.hpp"
#include "tools/files/record/recording.hpp"
#include "tools/simulate/plant_image_text.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire {

using test::refusal;

namespace {

constexpr std::uint64_t kCycles = 500;

ModelFile axis() {
  ModelFile model;
  model.name = "axis";
  model.parameters = SimplexParameters{};
  return model;
}

int status_of(const std::string& arguments) {
  return WEXITSTATUS(std::system((std::string{HOTFIRE_PROGRAM} + " " + arguments + " >/dev/null 2>&1").c_str()));
}

}  // namespace

TEST_GROUP(RecordingAsRecord) {
  test::Scratch scratch;
  const std::string path = scratch.path("run.hfr").string();

  /// Records the reference axis; each actuator gets the same command.
  void record_axis(std::size_t actuators = 1) const {
    auto options = test::recorded_options(path, kCycles - 10, actuators);
    options.source.amplitude = 0.01;
    options.source.shape = hal::sim::CommandSource::Shape::sine;
    test::record_run<model::Simplex<double>>(options, SimplexParameters{}, plant_image_text(axis()));
  }

  /// Leaves out the cycles of the recording that `left_out` names.
  template <class LeftOut>
  void drop(LeftOut && left_out) const {
    const auto keep = [&](std::uint64_t cycle, const std::string&) { return !left_out(cycle); };
    scratch.write("run.hfr", firmware::test_recording::rewritten(path, keep));
  }
};

TEST(RecordingAsRecord, HasTheInputAndEveryChannelWithTheirUnitsOnThePlantsTime) {
  record_axis();
  const Record record = load_record(path);
  UNSIGNED_LONGS_EQUAL(kCycles + 1, record.rows);
  DOUBLES_EQUAL(1e-3, record.period, 0.0);
  DOUBLES_EQUAL(0.0, record.start, 0.0);
  STRCMP_EQUAL("run.hfr", record.name.c_str());
  STRCMP_EQUAL("rad", record.find("command")->unit.c_str());
  STRCMP_EQUAL("Pa", record.find("load_pressure")->unit.c_str());
}

// What the loop did in real time is what the host's own simulation makes of the recorded commands.
TEST(RecordingAsRecord, SimulationOfTheRecordedCommandsGivesTheRecordedReadingsBitForBit) {
  record_axis();
  const Record record = load_record(path);
  const Record simulated = simulate(axis(), record);
  for (const char* channel : {"command", "piston", "engine", "load_pressure"}) {
    CHECK(record.find(channel)->values == simulated.find(channel)->values);
  }
  CHECK(std::abs(record.find("piston")->values.back()) > 0.0);
}

// Critically damped at 50 /s, a blow is below the smallest normal number after 15 s. The rig flushes it to zero, and the
// same bits are asked of the host.
TEST(RecordingAsRecord, ADecayNeverEntersDenormalNumbersAsItDoesNotOnTheRig) {
  ModelFile mass;
  DirectParameters parameters;
  parameters.mass = {1.0, 100.0, 2500.0};
  mass.parameters = parameters;
  Record blow;
  blow.period = 1e-3;
  blow.rows = 17000;
  blow.channels.push_back({"force", "", std::vector<double>(blow.rows, 0.0)});
  blow.channels.front().values.front() = 1.0;
  const std::vector<double> position = simulate(mass, blow).find("position")->values;
  CHECK(std::none_of(position.begin(), position.end(), [](double x) { return std::fpclassify(x) == FP_SUBNORMAL; }));
  DOUBLES_EQUAL(0.0, position.back(), 1e-300);
}

TEST(RecordingAsRecord, RecordWrittenAsCsvIsReadBackTheSame) {
  record_axis();
  const Record record = load_record(path);
  write_record(record, scratch.path("run.csv"));
  const Record again = load_record(scratch.path("run.csv"));
  for (const Channel& channel : record.channels) {
    CHECK(channel.values == again.find(channel.name)->values);
  }
}

TEST(RecordingAsRecord, SeveralActuatorsAreRefusedWithTheRemedyAndOneCanBeChosen) {
  record_axis(3);
  STRCMP_CONTAINS("3 actuators, and a record is of one; write the record of one with 'hotfire replay",
                  refusal([&] { load_record(path); }).c_str());
  STRCMP_CONTAINS("no actuator 4; allowed: 1 to 3", refusal([&] { load_recording(path, {4}); }).c_str());
  const Record second = load_recording(path, {2});
  UNSIGNED_LONGS_EQUAL(4, second.channels.size());
  UNSIGNED_LONGS_EQUAL(kCycles + 1, second.rows);
}

TEST(RecordingAsRecord, CyclesThatTheLoopLeftOutAreRefusedAsTheyAreRealTimeThatPassed) {
  record_axis();
  scratch.write("run.hfr", firmware::test_recording::rewritten(path, [](std::uint64_t cycle, std::string& bytes) {
                  if (cycle == 120) {
                    hal::CycleHead head;
                    std::memcpy(&head, bytes.data(), sizeof head);
                    head.flags |= std::uint64_t{20} << hal::CycleHead::kSkippedShift;
                    std::memcpy(bytes.data(), &head, sizeof head);
                  }
                  return cycle < 100 || cycle >= 120;
                }));
  STRCMP_CONTAINS("0 cycles were dropped and 20 skipped before cycle 120", refusal([&] { load_record(path); }).c_str());
}

TEST(RecordingAsRecord, DroppedCyclesAreRefusedAndBothSidesOfThemCanBeRead) {
  record_axis();
  const Record whole = load_record(path);
  drop([](std::uint64_t cycle) { return cycle >= 100 && cycle < 120; });
  STRCMP_CONTAINS("20 cycles were dropped and 0 skipped before cycle 120", refusal([&] { load_record(path); }).c_str());
  const Record before = load_recording(path, {0, 0, true});
  UNSIGNED_LONGS_EQUAL(101, before.rows);
  const Record after = load_recording(path, {0, 110, true});
  UNSIGNED_LONGS_EQUAL(kCycles - 121, after.rows);
  DOUBLES_EQUAL(122e-3, after.start, 1e-12);
  // The row at 122 ms, in both.
  DOUBLES_EQUAL(whole.find("piston")->values[122], after.find("piston")->values[0], 0.0);
  DOUBLES_EQUAL(whole.find("command")->values[122], after.find("command")->values[0], 0.0);
}

TEST(RecordingAsRecord, CommandsTakeARecordingWhereTheyTakeARecord) {
  record_axis();
  std::ofstream(scratch.path("axis.toml")) << model_text(axis());
  const std::string csv = scratch.path("out.csv").string();
  LONGS_EQUAL(0, status_of("check " + path));
  LONGS_EQUAL(0, status_of("replay " + path));
  LONGS_EQUAL(0, status_of("replay --json " + path));
  LONGS_EQUAL(0, status_of("replay " + path + " --csv " + csv));
  LONGS_EQUAL(0, status_of("check " + csv));
  LONGS_EQUAL(0,
              status_of("simulate --model " + scratch.path("axis.toml").string() + " --input " + path + " --output " + csv));
  LONGS_EQUAL(2, status_of("replay"));
  LONGS_EQUAL(2, status_of("replay " + path + " --actuator 1"));
  LONGS_EQUAL(6, status_of("replay " + csv));
  drop([](std::uint64_t cycle) { return cycle == 100; });
  LONGS_EQUAL(1, status_of("replay " + path));
  LONGS_EQUAL(6, status_of("check " + path));
}

TEST(RecordingAsRecord, LabIsARecordOfCommandAndPistonAndReplaysByTheCommand) {
  const std::uint64_t cycles = firmware::test_lab::record_lab(path);
  const Record record = load_recording(path);
  UNSIGNED_LONGS_EQUAL(2, record.channels.size());
  UNSIGNED_LONGS_EQUAL(cycles + 1, record.rows);
  hal::RecordingReader reader(path);
  hal::RecordedCycle cycle;
  // The first row is before the first cycle, and the end of a cycle is where the next one begins.
  for (std::size_t row = 1; reader.next(cycle); ++row) {
    DOUBLES_EQUAL(cycle.commands[0], record.find("command")->values[row], 0.0);
    CHECK(row + 1 == record.rows || cycle.readings[firmware::kPiston] == record.find("piston")->values[row + 1]);
  }
  LONGS_EQUAL(0, status_of("replay " + path));
  LONGS_EQUAL(0, status_of("replay " + path + " --from 1 --csv " + scratch.path("lab.csv").string()));
  LONGS_EQUAL(0, status_of("check " + scratch.path("lab.csv").string()));
}

TEST(RecordingAsRecord, LabThatMeasuresLoadPressuresIsARecordOfThemTooThatIsReadBackTheSame) {
  firmware::test_lab::record_lab(path, ~std::uint64_t{0}, firmware::test_lab::kLoadPressureLimit);
  const Record record = load_recording(path);
  UNSIGNED_LONGS_EQUAL(3, record.channels.size());
  const Channel* pressure = record.find("load_pressure");
  STRCMP_EQUAL("Pa", pressure->unit.c_str());
  hal::RecordingReader reader(path);
  hal::RecordedCycle cycle;
  for (std::size_t row = 1; reader.next(cycle); ++row) {
    DOUBLES_EQUAL(cycle.readings[firmware::kLoadPressureRead], pressure->values[row], 0.0);
  }
  LONGS_EQUAL(0, status_of("replay " + path + " --from 1 --csv " + scratch.path("lab.csv").string()));
  const Record again = load_record(scratch.path("lab.csv"));
  const std::vector<double>& rows = again.find("load_pressure")->values;
  CHECK(std::equal(rows.begin(), rows.end(), pressure->values.end() - static_cast<std::ptrdiff_t>(rows.size())));
}

}  // namespace hotfire
