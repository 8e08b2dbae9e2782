// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <sys/wait.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>

#include "firmware/plant/vehicle_plant.hpp"
#include "hal/arithmetic/denormals.hpp"
#include "hal/recording/reader.hpp"
#include "tests/firmware/plant/whole_vehicle.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tools/files/record/recording.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/simulate/vehicle_image_text.hpp"
#include "tools/simulate/vehicle_readings.hpp"

namespace hotfire {

namespace {

using Masv = model::Masv<double>;
using Rows = std::vector<std::vector<double>>;

constexpr std::size_t kAxes = Masv::kAxes;
constexpr double kVehicleRecordingPeriod = 1e-3;

int exit_status_of(const std::string& arguments) {
  return WEXITSTATUS(std::system((std::string{HOTFIRE_PROGRAM} + " " + arguments + " >/dev/null 2>&1").c_str()));
}

/// What `hotfire simulate` makes of the commands of some cycles: one row more than there are cycles, so that its last one
/// has what the sensors read at the end of the last cycle.
Record simulated(const VehicleFile& vehicle, const Rows& commands) {
  Record record;
  record.period = kVehicleRecordingPeriod;
  record.rows = commands.size() + 1;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Channel channel{"command." + axis_names(Masv::kEngines)[axis], "rad", {}};
    for (const std::vector<double>& row : commands) {
      channel.values.push_back(row[axis]);
    }
    channel.values.push_back(0.0);
    record.channels.push_back(channel);
  }
  return simulate(vehicle, record);
}

/// Compares what the sensors read at the end of every cycle, bit for bit.
void check_same_bits(const Record& offline, const Rows& readings) {
  const std::vector<std::string> axes = axis_names(Masv::kEngines);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    for (std::size_t c = 0; c < Masv::kChannels; ++c) {
      const std::string name = std::string(Masv::AxisModel::channels[c]) + "." + axes[axis];
      const std::vector<double>& values = offline.find(name)->values;
      for (std::size_t cycle = 0; cycle < readings.size(); ++cycle) {
        const double reading = readings[cycle][axis * Masv::kChannels + c];
        if (std::bit_cast<std::uint64_t>(values[cycle + 1]) != std::bit_cast<std::uint64_t>(reading)) {
          FAIL(StringFromFormat("%s in cycle %u: simulated %.17g, in real time %.17g", name.c_str(),
                                static_cast<unsigned>(cycle), values[cycle + 1], reading)
                   .asCharString());
        }
      }
    }
  }
}

}  // namespace

TEST_GROUP(VehicleRecording) {
  test::Scratch scratch;
  const VehicleFile vehicle = test::whole_vehicle(scratch);
  const std::string model = scratch.path("vehicle.toml").string();
  const std::string path = scratch.path("run.hfr").string();
};

TEST(VehicleRecording, ProgramInRealTimeGivesTheBitsOfTheOfflineSimulationAndReplaysThem) {
  LONGS_EQUAL(0,
              exit_status_of("plant --model " + model + " --bus sim --cycles 1500 --warm-up 20 --command sine --amplitude " +
                             "0.02 --frequency 3 --record " + path));
  LONGS_EQUAL(0, exit_status_of("replay " + path));
  hal::RecordingReader reader(path);
  STRCMP_EQUAL("masv", reader.header().topology.c_str());
  UNSIGNED_LONGS_EQUAL(kAxes, reader.header().actuators);
  Rows commands;
  Rows readings;
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
    commands.emplace_back(cycle.commands.begin(), cycle.commands.end());
    readings.emplace_back(cycle.readings.begin(), cycle.readings.end());
  }
  UNSIGNED_LONGS_EQUAL(1520, readings.size());
  CHECK(std::abs(readings.back()[0] - readings.front()[0]) > 0.0);
  check_same_bits(simulated(vehicle, commands), readings);
}

TEST(VehicleRecording, IsARecordOfAllItsAxesWhoseSimulationGivesTheSameBits) {
  LONGS_EQUAL(
      0, exit_status_of("plant --model " + model + " --bus sim --cycles 400 --warm-up 0 --command sine --record " + path));
  const Record record = load_record(path);
  UNSIGNED_LONGS_EQUAL(400, record.rows);
  UNSIGNED_LONGS_EQUAL(kAxes * (1 + Masv::kChannels), record.channels.size());
  DOUBLES_EQUAL(0.0, record.start, 0.0);
  const Record offline = simulate(vehicle, record);
  for (const Channel& channel : record.channels) {
    CHECK_TRUE_TEXT(channel.values == offline.find(channel.name)->values, channel.name.c_str());
  }
  const Record later = load_recording(path, {0, 100, true});
  DOUBLES_EQUAL(0.101, later.start, 1e-12);
  DOUBLES_EQUAL(record.find("engine.yaw3")->values[101], later.find("engine.yaw3")->values[0], 0.0);
  const Record one = load_recording(path, {6});
  CHECK(one.find("engine")->values == record.find("engine.yaw3")->values);
  LONGS_EQUAL(
      0, exit_status_of("simulate --model " + model + " --input " + path + " --output " + scratch.path("s.csv").string()));
}

TEST(VehicleRecording, EveryAxisUnderItsOwnCommandGivesTheBitsOfTheOfflineSimulationStringsToo) {
  constexpr std::size_t kCycles = 800;
  const hal::FlushDenormals flush;
  Normal normal(VehicleRun{}.seed);
  const auto parameters = std::make_unique<model::InstrumentedVehicle<Masv>>(model::InstrumentedVehicle<Masv>{
      std::get<MasvParameters>(vehicle.parameters), sensors_in_place<Masv>(vehicle.sensors, normal)});
  const auto plant = std::make_unique<firmware::VehiclePlant<Masv>>(*parameters, kVehicleRecordingPeriod);
  plant->string_up();
  Rows commands;
  Rows readings;
  Rows strings;
  hal::Command command;
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double rate = 5.0 + 3.0 * static_cast<double>(axis);
      command.values[axis] = 0.01 * std::sin(rate * static_cast<double>(cycle) * kVehicleRecordingPeriod);
    }
    plant->step(command);
    commands.emplace_back(command.values.begin(), command.values.end());
    readings.emplace_back(plant->measured().begin(), plant->measured().end());
    strings.emplace_back(plant->strings().begin(), plant->strings().end());
  }
  const Record offline = simulated(vehicle, commands);
  check_same_bits(offline, readings);
  for (std::size_t i = 0; i < strings.front().size(); ++i) {
    const std::string name = "string" + std::to_string(i % 4 + 1) + ".engine" + std::to_string(i / 4 + 1);
    for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
      DOUBLES_EQUAL(offline.find(name)->values[cycle + 1], strings[cycle][i], 0.0);
    }
  }
}

TEST(VehicleRecording, NoiseAndFaultsOfTheirFilesAreReplayedToTheSameBits) {
  const std::string line = "step = \"5.3 um\"\n";
  std::string text = test::kWholeVehicle;
  text.insert(text.find(line), "noise = \"20 um\"\n");
  const std::string noisy = scratch.write("noisy.toml", text).string();
  const std::string faults =
      scratch
          .write("faults.toml",
                 "schema = 1\n[[fault]]\nkind = \"leak\"\nactuator = 3\nfrom = 0.1\nto = 0.3\nvalue = 1e-9\n"
                 "[[fault]]\nkind = \"lost_supply\"\nactuator = 8\nfrom = 0.2\nvalue = \"200 psi\"\n"
                 "[[fault]]\nkind = \"biased\"\nchannel = \"engine\"\nfrom = 0.25\nvalue = \"1 deg\"\n")
          .string();
  LONGS_EQUAL(0,
              exit_status_of("plant --model " + noisy + " --faults " + faults + " --bus sim --cycles 500 --record " + path));
  LONGS_EQUAL(0, exit_status_of("replay " + path));
  scratch.write("faults.toml", "schema = 1\n[[fault]]\nkind = \"leak\"\nactuator = 9\nfrom = 0\nvalue = 1e-9\n");
  LONGS_EQUAL(6, exit_status_of("plant --model " + model + " --faults " + faults + " --bus sim --cycles 10"));
}

// The executable with the allocation guard linked in; a build with sanitizers has none and prints no such line.
TEST(VehicleRecording, LoopOfTheProgramTakesNothingFromTheHeap) {
  const std::string image = scratch.write("vehicle.image", plant_image_text(vehicle)).string();
  const std::string report = scratch.path("report").string();
  const std::string line = std::string{HOTFIRE_GUARDED_PROGRAM} + " plant --image " + image + " --cycles 300 --record " +
                           path + " >" + report + " 2>/dev/null";
  LONGS_EQUAL(0, std::system(line.c_str()));
  std::ifstream file(report);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  STRCMP_CONTAINS("masv of 8 actuators on bus sim", text.c_str());
  if (test::AllocationGuard::available) {
    STRCMP_CONTAINS("  allocations   0\n", text.c_str());
  }
}

TEST(VehicleRecording, NumberOfActuatorsFollowsFromTheModelAndAnotherIsRefused) {
  LONGS_EQUAL(0, exit_status_of("timing --model " + model + " --cycles 50 --max-overruns 1000 --actuators 8"));
  LONGS_EQUAL(2, exit_status_of("plant --model " + model + " --bus sim --cycles 50 --actuators 4"));
  LONGS_EQUAL(2, exit_status_of("plant --model " + model + " --bus can0 --layout classic --cycles 50"));
}

}  // namespace hotfire
