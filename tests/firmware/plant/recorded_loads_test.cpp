// SPDX-License-Identifier: Apache-2.0
#include "firmware/plant/recorded_loads.hpp"

#include <sys/wait.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

#include "firmware/image/plant_image.hpp"
#include "hal/recording/reader.hpp"
#include "tests/files/expect.hpp"
#include "tests/firmware/plant/whole_vehicle.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tools/simulate/disturbances.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/simulate/vehicle_image_text.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire {

namespace {

constexpr std::size_t kRows = 600;
constexpr double kPeriod = 1e-3;

int status_of(const std::string& arguments) {
  return WEXITSTATUS(std::system((std::string{HOTFIRE_PROGRAM} + " " + arguments + " >/dev/null 2>&1").c_str()));
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Record record_of(double period, std::size_t rows) {
  Record record;
  record.period = period;
  record.rows = rows;
  return record;
}

void add(Record& record, const std::string& name, const std::string& unit, const std::function<double(double)>& at) {
  Channel channel{name, unit, {}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    channel.values.push_back(at(static_cast<double>(row) * record.period));
  }
  record.channels.push_back(channel);
}

/// A disturbance of every kind for a vehicle of four engines, up to a fifth of the sampling rate; none of them ends at zero.
Record disturbed(double period, std::size_t rows) {
  Record record = record_of(period, rows);
  add(record, "torque.pitch2", "N.m", [=](double t) { return 2e4 * std::sin(1.1 / period * t) + 1e4 * std::cos(30.0 * t); });
  add(record, "torque.yaw4", "N.m", [](double t) { return -1.5e4 * std::cos(21.0 * t); });
  add(record, "force.x3", "N", [](double t) { return 3e5 * std::cos(40.0 * t); });
  add(record, "force.z1", "N", [](double t) { return 2e5 * std::cos(55.0 * t); });
  add(record, "vibration.yaw1", "rad/s", [](double t) { return 0.02 * std::cos(180.0 * t); });
  add(record, "thrust.engine4", "N", [](double t) { return t < 0.2 ? 2e5 : 1.6e6; });
  return record;
}

/// What a recording has of commands and readings, cycle after cycle.
struct Recorded {
  explicit Recorded(const std::string& path) {
    hal::RecordingReader reader(path);
    hal::RecordedCycle cycle;
    while (reader.next(cycle)) {
      commands.emplace_back(cycle.commands.begin(), cycle.commands.end());
      readings.emplace_back(cycle.readings.begin(), cycle.readings.end());
    }
  }
  std::vector<std::vector<double>> commands;
  std::vector<std::vector<double>> readings;
};

/// Compares what the sensors read at the end of every row of the record, which lasts `cycles`, bit for bit.
void expect_bits(const Record& offline, const Recorded& recorded, const std::vector<std::string>& channels,
                 std::size_t cycles) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::vector<double>& values = offline.find(channels[i])->values;
    for (std::size_t row = 1; row < values.size(); ++row) {
      const double reading = recorded.readings[row * cycles - 1][i];
      if (std::bit_cast<std::uint64_t>(values[row]) != std::bit_cast<std::uint64_t>(reading)) {
        FAIL(StringFromFormat("%s in row %u: simulated %.17g, in real time %.17g", channels[i].c_str(),
                              static_cast<unsigned>(row), values[row], reading)
                 .asCharString());
      }
    }
  }
}

std::vector<std::string> channels_of_masv() {
  std::vector<std::string> channels;
  for (const std::string& axis : axis_names(4)) {
    for (const char* channel : {"piston.", "engine.", "load_pressure."}) {
      channels.push_back(channel + axis);
    }
  }
  return channels;
}

std::string loads_text(const std::string& values) {
  return "disturbance.period 0.001\ndisturbance.rows 3\ndisturbance.0.kind torque\ndisturbance.0.place 0\n"
         "disturbance.0.values " +
         values + "\n";
}

}  // namespace

TEST_GROUP(RecordedLoads) {
  test::Scratch scratch;
  const VehicleFile vehicle = test::whole_vehicle(scratch);
  const std::string model = scratch.path("vehicle.toml").string();
  const std::string disturbances = scratch.path("disturbances.csv").string();
  const std::string path = scratch.path("run.hfr").string();

  int plays(const std::string& more) const {
    return status_of("plant --model " + model + " --disturbances " + disturbances + " --bus sim --warm-up 0 " + more);
  }
};

TEST(RecordedLoads, PlantInRealTimeGivesTheBitsOfSimulateOverTheSameRecordAndReplaysThem) {
  Record record = disturbed(kPeriod, kRows);
  write_record(record, disturbances);
  LONGS_EQUAL(0, plays("--cycles 700 --command sine --amplitude 0.01 --record " + path));
  LONGS_EQUAL(0, status_of("replay " + path));
  const Recorded recorded(path);
  for (std::size_t axis = 0; axis < 8; ++axis) {
    Channel command{"command." + axis_names(4)[axis], "rad", {}};
    for (std::size_t row = 0; row < kRows; ++row) {
      command.values.push_back(recorded.commands[row][axis]);
    }
    record.channels.push_back(command);
  }
  expect_bits(simulate(vehicle, record), recorded, channels_of_masv(), 1);
}

// A controller that holds its command for two cycles sees what `simulate` says of rows of that length, but for the lag of a
// sensor, which is read twice as often.
TEST(RecordedLoads, RowsThatLastTwoCyclesArePlayedAtTheirPace) {
  Record record = disturbed(2.0 * kPeriod, kRows / 2);
  write_record(record, disturbances);
  std::string text = test::kWholeVehicle;
  const std::string lag = "lag = \"2.1 ms\"\n";
  const VehicleFile without_lag = load_vehicle(scratch.write("vehicle.toml", text.erase(text.find(lag), lag.size())));
  LONGS_EQUAL(0, plays("--cycles 600 --command rest --record " + path));
  add(record, "command.pitch1", "rad", [](double) { return 0.0; });
  expect_bits(simulate(without_lag, record), Recorded(path), channels_of_masv(), 2);
}

TEST(RecordedLoads, OneAxisUnderARecordedTorqueGivesTheBitsOfSimulateOnEveryActuator) {
  const std::string axis = scratch.write("axis.toml", "schema = 1\ntopology = \"simplex\"\n").string();
  Record record = record_of(kPeriod, kRows);
  add(record, "torque", "N.m", [](double t) { return 2e4 * std::sin(300.0 * t); });
  write_record(record, disturbances);
  LONGS_EQUAL(0, status_of("plant --model " + axis + " --disturbances " + disturbances +
                           " --bus sim --actuators 2 --warm-up 0 --cycles 600 --command sine --record " + path));
  const Recorded recorded(path);
  Channel command{"command", "rad", {}};
  for (const std::vector<double>& row : recorded.commands) {
    command.values.push_back(row[1]);
  }
  record.channels.push_back(command);
  const Record offline = simulate(load_model(axis), record);
  expect_bits(offline, recorded, {"piston", "engine", "load_pressure"}, 1);
  for (const std::vector<double>& readings : recorded.readings) {
    DOUBLES_EQUAL(readings[1], readings[4], 0.0);
  }
}

TEST(RecordedLoads, AfterTheLastRowTheThrustIsTheDeclaredOneAndAllElseIsZero) {
  const firmware::RecordedLoads loads({kPeriod,
                                       {{firmware::RecordedKind::torque, 1, {5.0, 5.0}},
                                        {firmware::RecordedKind::vibration, 0, {0.1, 0.2}},
                                        {firmware::RecordedKind::thrust, 0, {1e5, 2e5}}}},
                                      kPeriod, 2);
  const auto acting = [&](std::uint64_t cycle) {
    std::vector<double> values;
    loads.act_in(cycle, 1, [&](firmware::RecordedKind, std::size_t, double value) { values.push_back(value); });
    return values;
  };
  UNSIGNED_LONGS_EQUAL(3, acting(1).size());
  DOUBLES_EQUAL(5.0, acting(1)[0], 1e-12);
  DOUBLES_EQUAL(2e5, acting(1)[2], 0.0);
  UNSIGNED_LONGS_EQUAL(2, acting(2).size());
  DOUBLES_EQUAL(0.0, acting(2)[0], 0.0);
  DOUBLES_EQUAL(0.0, acting(1'000'000'000'000)[1], 0.0);
}

// The executable with the allocation guard linked in; a build with sanitizers has none and prints no such line.
TEST(RecordedLoads, PlayingTakesNothingFromTheHeap) {
  const Record record = disturbed(kPeriod, 200);
  const std::string image =
      scratch
          .write("vehicle.image",
                 plant_image_text(vehicle) +
                     disturbances_image_text(record,
                                             disturbances_of(record, std::get<MasvParameters>(vehicle.parameters).gimbals)))
          .string();
  const std::string report = scratch.path("report").string();
  const std::string line = std::string{HOTFIRE_GUARDED_PROGRAM} + " plant --image " + image + " --cycles 300 >" + report;
  LONGS_EQUAL(0, std::system(line.c_str()));
  if (test::AllocationGuard::available) {
    STRCMP_CONTAINS("  allocations   0\n", text_of(report).c_str());
  }
}

TEST(RecordedLoads, RowsThatDoNotLastAWholeNumberOfCyclesAreRefusedAtTheStart) {
  CHECK(!firmware::cycles_per_row(1e-3, 2e-3));
  CHECK(!firmware::cycles_per_row(1.5e-3, 1e-3));
  LONGS_EQUAL(4, firmware::cycles_per_row(1e-3, 250e-6).value());
  write_record(disturbed(kPeriod, kRows), disturbances);
  LONGS_EQUAL(2, plays("--cycles 10 --period-us 400"));
  LONGS_EQUAL(0, plays("--cycles 10 --period-us 500"));
}

TEST(RecordedLoads, ARecordThatCannotBePlayedIsRefusedWithItsLineAndWhatIsAllowed) {
  const auto& gimbals = std::get<MasvParameters>(vehicle.parameters).gimbals;
  const auto refused = [&](const std::string& text, std::initializer_list<const char*> parts) {
    scratch.write("disturbances.csv", text);
    test::expect_message(test::refusal([&] {
                           const Record record = load_record(disturbances);
                           disturbances_image_text(record, disturbances_of(record, gimbals));
                         }),
                         parts);
  };
  refused("# a comment\ntime[s],torque.yaw2[N.m]\n0,1\n0.001,2\n0.002,2e7\n",
          {"disturbances.csv:5: ", "torque.yaw2 = 2e+07", "allowed: -1e+07 to 1e+07 N.m"});
  refused("time[s],thrust.engine2[N]\n0,1\n0.001,-1\n", {"disturbances.csv:3: ", "thrust.engine2 = -1", "0 to 1e+08 N"});
  refused("time[s],command.pitch1[rad]\n0,1\n0.001,2\n", {"disturbances.csv:1: ", "no channel", "torque.pitch"});
  refused("time[s],torque.pitch1[N.m]\n0,1\n0.001,x\n", {"disturbances.csv:3:"});
  Record record = record_of(kPeriod, 2'000'001);
  add(record, "torque.pitch1", "N.m", [](double) { return 0.0; });
  test::expect_message(test::refusal([&] { disturbances_image_text(record, disturbances_of(record, gimbals)); }),
                       {"2000001 rows", "allowed: 2000000 rows", "import"});
  LONGS_EQUAL(6, plays("--cycles 10"));
  write_record(disturbed(kPeriod, kRows), disturbances);
  const std::string mass = scratch.write("mass.toml", "schema = 1\ntopology = \"direct\"\n").string();
  LONGS_EQUAL(6, status_of("plant --model " + mass + " --disturbances " + disturbances + " --bus sim --cycles 10"));
}

TEST(RecordedLoads, AnImageWithDisturbancesThatCannotBeIsRefused) {
  const std::string axis = plant_image_text(SimplexParameters{});
  const auto error = [&](const std::string& lines) { return firmware::parse_plant_image(axis + lines, "image").error; };
  STRCMP_EQUAL("", error(loads_text("1,2,3")).c_str());
  STRCMP_CONTAINS("disturbance.0.values = 1,2: allowed is 3 numbers", error(loads_text("1,2")).c_str());
  STRCMP_CONTAINS("allowed is 3 numbers", error(loads_text("1,2,nan")).c_str());
  STRCMP_CONTAINS("allowed is 3 numbers", error(loads_text("1,2,1e8")).c_str());
  STRCMP_CONTAINS("of topology taos or masv",
                  error("disturbance.period 0.001\ndisturbance.rows 1\ndisturbance.0.kind thrust\ndisturbance.0.place 0\n"
                        "disturbance.0.values 1\n")
                      .c_str());
  STRCMP_CONTAINS("disturbance.rows", error("disturbance.period 0.001\ndisturbance.rows 3000000\n").c_str());
  STRCMP_CONTAINS("disturbance.1.kind = torque: unknown key",
                  error("disturbance.period 0.001\ndisturbance.rows 1\ndisturbance.1.kind torque\n").c_str());
}

}  // namespace hotfire
