// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/vehicle_sensors.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "tests/structure/vehicle_texts.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/mode_table.hpp"
#include "tools/structure/synthetic.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

/// A pitch command that goes on moving the engine.
Record swing(const std::string& axis, double size, std::size_t rows) {
  Record record;
  record.path = record.name = "swing";
  record.period = 1e-3;
  record.rows = rows;
  record.channels.push_back({"command." + axis, "rad", {}});
  for (std::size_t row = 0; row < rows; ++row) {
    record.channels.front().values.push_back(size * std::sin(20.0 * static_cast<double>(row) * record.period));
  }
  return record;
}

double rms_between(const Record& a, const Record& b, const std::string& channel) {
  const std::vector<double>& x = a.find(channel)->values;
  const std::vector<double>& y = b.find(channel)->values;
  double sum = 0.0;
  for (std::size_t row = 0; row < x.size(); ++row) {
    sum += (x[row] - y[row]) * (x[row] - y[row]);
  }
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

TEST_GROUP_BASE(VehicleSensors, VehicleTexts){};

TEST(VehicleSensors, GiveEveryEngineFourStringsWhereTheyAreAsked) {
  POINTERS_EQUAL(nullptr, simulate(load(kTaos), swing("pitch", 0.01, 10)).find("string1"));
  const Record one = simulate(load(kTaos + "[strings]\n"), swing("pitch", 0.01, 10));
  CHECK_TRUE(one.find("string4") != nullptr && one.find("string4")->unit == "m");
  const Record four = simulate(load(kMasv + "[strings]\n"), swing("pitch1", 0.01, 10));
  LONGS_EQUAL(8 * 4 + 16, four.channels.size());
  CHECK_TRUE(four.find("string3.engine4") != nullptr);
}

TEST(VehicleSensors, MeasureTheAnglesBetweenTheEndsTheyAreGiven) {
  const VehicleFile model = load(kTaos +
                                 "[strings.string1]\nengine_x = -2.0\nvehicle_x = "
                                 "-2.0\nvehicle_z = -4.0\n");
  const Record run = simulate(model, swing("pitch", 0.02, 800));
  const Eigen::Vector3d engine(-2.0, 0.0, -0.6);
  const Eigen::Vector3d vehicle(-2.0, 0.1, -4.0);
  for (const std::size_t row : {0U, 300U, 799U}) {
    const Eigen::AngleAxisd pitch(run.find("engine.pitch")->values[row], Eigen::Vector3d::UnitY());
    const Eigen::AngleAxisd yaw(run.find("engine.yaw")->values[row], Eigen::Vector3d::UnitZ());
    const double length = (pitch * (yaw * engine) - vehicle).norm();
    DOUBLES_EQUAL(length - (engine - vehicle).norm(), run.find("string1")->values[row], 1e-12);
  }
}

TEST(VehicleSensors, TakeWhatIsSaidOfAllEnginesAndThenOfOne) {
  const VehicleFile model = load(kMasv +
                                 "[strings]\nlag = \"2 ms\"\n[strings.string2]\nengine_z = "
                                 "0.7\n[strings.string2.engine3]\nengine_z = 0.8\n");
  DOUBLES_EQUAL(2e-3, model.sensors.string.lag, 1e-15);
  DOUBLES_EQUAL(0.7, model.sensors.strings[0][1].engine_z, 0.0);
  DOUBLES_EQUAL(0.8, model.sensors.strings[2][1].engine_z, 0.0);
}

TEST(VehicleSensors, ReadInStepsAndWithNoiseOfTheirSeed) {
  const std::string text = kTaos + "[sensors.piston]\nnoise = \"20 um\"\n[strings]\nstep = \"1 mm\"\n";
  const VehicleFile model = load(text);
  const Record inputs = swing("pitch", 0.02, 2000);
  const Record ideal = simulate(load(kTaos + "[strings]\n"), inputs);
  const Record run = simulate(model, inputs);
  CHECK_TRUE(run.find("piston.pitch")->values == simulate(model, inputs).find("piston.pitch")->values);
  CHECK_FALSE(run.find("piston.pitch")->values == simulate(model, inputs, {.seed = 2}).find("piston.pitch")->values);
  // The rms of 2000 draws is known to within 1 / sqrt(4000), here four times
  // that.
  DOUBLES_EQUAL(2e-5, rms_between(run, ideal, "piston.pitch"), 0.064 * 2e-5);
  for (const double length : run.find("string1")->values) {
    DOUBLES_EQUAL(0.0, std::remainder(length, 1e-3), 1e-12);
  }
  // The engine does not know how it is measured.
  CHECK_TRUE(run.find("engine.pitch")->values == ideal.find("engine.pitch")->values);
}

TEST(VehicleSensors, LagBehindThePiston) {
  const Record inputs = swing("pitch", 0.02, 2000);
  const Record late = simulate(load(kTaos + "[sensors.piston]\nlag = \"10 ms\"\n"), inputs);
  const Record ideal = simulate(load(kTaos), inputs);
  // lag r' + r = x of a sine of 20 rad/s: the gain at which it follows, once
  // the start has died out.
  double largest = 0.0;
  double wanted = 0.0;
  for (std::size_t row = 1000; row < 2000; ++row) {
    largest = std::max(largest, std::abs(late.find("piston.pitch")->values[row]));
    wanted = std::max(wanted, std::abs(ideal.find("piston.pitch")->values[row]));
  }
  DOUBLES_EQUAL(1.0 / std::hypot(1.0, 20.0 * 0.01), largest / wanted, 2e-3);
}

TEST(VehicleSensors, AreOffByTheirPlacementAndDrawItFromTheSeed) {
  const Record inputs = swing("pitch", 0.02, 500);
  const Record drawn = simulate(load(kTaos + "[strings]\n"), inputs);
  const VehicleFile model = load(kTaos + "[strings]\nplacement_error = \"2 cm\"\n");
  const double off = rms_between(simulate(model, inputs), drawn, "string1");
  // A length of 1.4 m whose anchor is off by some centimetres changes by
  // percents less or more.
  CHECK_TRUE(off > 1e-6 && off < 1e-2);
  CHECK_TRUE(std::abs(off - rms_between(simulate(model, inputs, {.seed = 5}), drawn, "string1")) > 1e-7);
}

// The anchors ride on the modes, the engine's ends on the bearing: neither
// turns the engine, and both move the strings.
TEST(VehicleSensors, SeeTheMotionOfTheStructureAndOfTheBearing) {
  const std::string with_modes = kMasv + "[strings]\n[modes]\ntable = \"modes.csv\"\n";
  const Record inputs = swing("pitch1", 0.02, 1000);
  ModeSet modes = synthetic_vehicle(3, 30);
  scratch.write("modes.csv", mode_table_text(modes, {}));
  const Record moved = simulate(load(with_modes), inputs);
  modes.string_shape.setZero();
  scratch.write("modes.csv", mode_table_text(modes, {}));
  const Record still = simulate(load(with_modes), inputs);
  CHECK_TRUE(moved.find("engine.pitch1")->values == still.find("engine.pitch1")->values);
  CHECK_TRUE(rms_between(moved, still, "string1.engine1") > 1e-6);

  std::string soft = kTaos + "[strings]\n[gimbal]\nthrust = 1e6\nstiffness = [";
  for (int row = 0; row < 6; ++row) {
    soft += "[";
    for (int column = 0; column < 6; ++column) {
      soft += row != column ? "0, " : row < 3 ? "1e8, " : "1e9, ";
    }
    soft += "],";
  }
  const Record pushed = simulate(load(soft + "]\n"), swing("pitch", 0.0, 10));
  // 1 MN on 1e8 N/m: 10 mm forward, against strings that lead from -1 m to 0.2
  // m over a length of 1.4 m.
  const double angle = pushed.find("engine.pitch")->values[0];
  CHECK_TRUE(std::abs(angle) > 1e-4);
  const auto representative = VehicleSensors::Strings::representative()[0];
  const Eigen::Vector3d line = representative.engine() - representative.vehicle();
  const double turned = VehicleSensors::Strings(VehicleSensors::Strings::representative())
                            .lengths(angle, pushed.find("engine.yaw")->values[0], Eigen::Vector3d::Zero())[0];
  DOUBLES_EQUAL(0.01 * line.x() / line.norm(), pushed.find("string1")->values[0] - turned, 3e-4);
}

TEST(VehicleSensors, AreRefusedWithWhatAndWhere) {
  expect_message(refused(kTaos + "[strings]\nlagg = 1\n"), {"v.toml:4:", "strings.lagg", "unknown key", "lag"});
  expect_message(refused(kTaos + "[strings]\nlag = -1\n"), {"v.toml:4:", "strings.lag", "allowed: 0 to"});
  expect_message(refused(kTaos + "[strings]\nplacement_error = \"2 s\"\n"), {"v.toml:4:", "strings.placement_error"});
  expect_message(refused(kTaos + "[strings]\nplacement_error = 2\n"), {"v.toml:4:", "placement_error", "allowed: 0 to 1 m"});
  expect_message(refused(kTaos + "[strings.string5]\n"), {"v.toml:3:", "strings.string5", "unknown key"});
  expect_message(refused(kTaos + "[strings.string1.engine2]\n"), {"v.toml:3:", "strings.string1.engine2", "unknown key"});
  expect_message(refused(kMasv + "[strings.string1.engine5]\n"), {"v.toml:3:", "strings.string1.engine5", "engine1"});
  expect_message(refused(kTaos + "[strings.string1]\nvehicle_x = -1\nvehicle_y "
                                 "= 0\nvehicle_z = -0.6\n"),
                 {"v.toml:3:", "strings", "coincide"});
  expect_message(refused(kTaos + "[sensors]\nengine = 1\n"), {"v.toml:4:", "sensors.engine", "piston"});
  expect_message(refused(kTaos + "[sensors.piston]\nnoise = nan\n"), {"v.toml:4:", "sensors.piston.noise"});
}

}  // namespace hotfire::test
