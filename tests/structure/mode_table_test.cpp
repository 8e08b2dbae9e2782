// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/mode_table.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>

#include "model/vehicle.hpp"
#include "tests/files/scratch.hpp"
#include "tools/structure/synthetic.hpp"

namespace hotfire::test {
namespace {

const std::string kHeader =
    "mode,frequency[Hz],damping[1],attach.pitch1,"
    "attach.yaw1,gimbal.pitch1,gimbal.yaw1\n";

/// The message with which a table of this text is refused.
std::string refused(const std::string& text) {
  const Scratch scratch;
  const auto path = scratch.write("modes.csv", text);
  const std::string message = refusal([&] { load_modes(path); });
  // Every message says where.
  CHECK_TRUE(message.starts_with(path.string() + ":"));
  return message.substr(path.string().size() + 1);
}

void check_says(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words) {
    if (message.find(word) == std::string::npos) {
      FAIL(("does not say '" + std::string(word) + "': " + message).c_str());
    }
  }
}

}  // namespace

TEST_GROUP(ModeTableFile){};

TEST(ModeTableFile, IsReadBackBitForBit) {
  ModeSet modes = synthetic_vehicle(5, 12);
  modes.residual = 1e-9 * (Eigen::MatrixXd::Identity(16, 16) + Eigen::MatrixXd::Constant(16, 16, 0.1));
  const Scratch scratch;
  const ModeSet again = load_modes(scratch.write("modes.csv", mode_table_text(modes, {"a comment", "and another"})));
  CHECK_TRUE(again.engines == 4 && again.modes() == 12);
  CHECK_TRUE(again.frequency == modes.frequency && again.damping_ratio == modes.damping_ratio);
  CHECK_TRUE(again.shape == modes.shape && again.residual == modes.residual);
  CHECK_TRUE(again.string_shape == modes.string_shape && again.string_shape.rows() == 16);
}

TEST(ModeTableFile, HasStringsOfAllEnginesOrNone) {
  const std::string strings =
      "mode,frequency[Hz],damping[1],attach.pitch1,"
      "attach.yaw1,gimbal.pitch1,gimbal.yaw1,"
      "string1.engine1,string2.engine1,string3.engine1";
  check_says(refused(strings + "\n1,5,0.01,1,1,0,0,1,2,3\n"), {"1:", "no column string4.engine1"});
  check_says(refused(strings + ",string5.engine1\n"), {"string5.engine1", "unknown"});
  check_says(refused(strings + ",string4.engine1\n1,5,0.01,1,1,0,0,1,2,,4\n"), {"2:", "missing shape at string3.engine1"});
  const Scratch scratch;
  const ModeSet modes = load_modes(scratch.write("modes.csv", strings + ",string4.engine1\n1,5,0.01,1,1,0,0,1,2,3,"
                                                                        "4\nresidual.attach.pitch1,,,1e-9,0,0,0,5,6,7,8\n"
                                                                        "residual.attach.yaw1,,,0,0,0,0,0,0,0,0\nresidual."
                                                                        "gimbal.pitch1,,,0,0,0,0,0,0,0,0\n"
                                                                        "residual.gimbal.yaw1,,,0,0,0,0,0,0,0,9\n"));
  DOUBLES_EQUAL(3.0, modes.string_shape(2, 0), 0.0);
  DOUBLES_EQUAL(6.0, modes.string_residual(1, 0), 0.0);
  DOUBLES_EQUAL(9.0, modes.string_residual(3, 3), 0.0);
}

TEST(ModeTableFile, TakesItsColumnsInAnyOrder) {
  const Scratch scratch;
  const ModeSet modes = load_modes(scratch.write("modes.csv",
                                                 "gimbal.yaw1,attach.yaw1,mode,damping[1],gimbal.pitch1,"
                                                 "frequency[Hz],attach.pitch1\n4,2,first,0.01,3,5.5,1\n"));
  CHECK_TRUE(modes.modes() == 1 && modes.engines == 1);
  DOUBLES_EQUAL(5.5, modes.frequency(0), 0.0);
  for (int port = 0; port < 4; ++port) {
    DOUBLES_EQUAL(port + 1.0, modes.shape(port, 0), 0.0);
  }
}

TEST(ModeTableFile, KeepsAModeOfTheRigidBodyForTheAttitudeAlone) {
  const Scratch scratch;
  const std::string header =
      "mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,gimbal.pitch1,gimbal.yaw1,side.pitch1,side.yaw1,sensor.pitch,"
      "sensor.yaw\n";
  const ModeSet modes =
      load_modes(scratch.write("modes.csv", header + "pitch,0,0,0,0,0,0,2,3,4,5\n1,5,0.01,1,2,3,4,6,7,8,9\n"));
  LONGS_EQUAL(1, modes.modes());
  DOUBLES_EQUAL(5.0, modes.frequency(0), 0.0);
  DOUBLES_EQUAL(2.0, modes.shape(1, 0), 0.0);
  LONGS_EQUAL(2, modes.flight.frequency.size());
  DOUBLES_EQUAL(0.0, modes.flight.frequency(0), 0.0);
  DOUBLES_EQUAL(3.0, modes.flight.side(1, 0), 0.0);
  DOUBLES_EQUAL(9.0, modes.flight.sensor(1, 1), 0.0);
  check_says(refused(header + "1,5,0.01,1,2,3,4,6,,8,9\n"), {"2:", "missing shape at side.yaw1"});
  check_says(refused("mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,gimbal.pitch1,gimbal.yaw1,sensor.pitch\n"),
             {"1:", "no column side.pitch1"});
  check_says(refused(kHeader + "1,0,0.01,1,1,0,0\n"), {"2:", "frequency[Hz] = \"0\"", "side and sensor"});
}

TEST(ModeTableFile, WritesTheModesOfAFlightAsItReadThem) {
  const Scratch scratch;
  const std::string rows =
      "mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,gimbal.pitch1,gimbal.yaw1,side.pitch1,side.yaw1,sensor.pitch,"
      "sensor.yaw\n1,0,0,0.5,0,0,0,2,3,4,5\n2,5,0.01,1,2,3,4,6,7,8,9\nresidual.attach.pitch1,,,1e-09,0,0,0,,,,\n"
      "residual.attach.yaw1,,,0,1e-09,0,0,,,,\nresidual.gimbal.pitch1,,,0,0,1e-09,0,,,,\n"
      "residual.gimbal.yaw1,,,0,0,0,1e-09,,,,\n";
  STRCMP_EQUAL(rows.c_str(), mode_table_text(load_modes(scratch.write("modes.csv", rows)), {}).c_str());
}

TEST(ModeTableFile, HasThePortsOfTheModel) {
  LONGS_EQUAL(model::Masv<double>::kPorts, port_names(kMostEngines).size());
  LONGS_EQUAL(model::Masv<double>::kEngines, kMostEngines);
}

TEST(ModeTableFile, RefusesAMissingShape) {
  check_says(refused(kHeader + "1,5,0.01,1e-3,,0,0\n"), {"2:", "mode 1", "missing shape at attach.yaw1"});
  check_says(refused("mode,frequency[Hz],damping[1],attach.pitch1,gimbal."
                     "pitch1,gimbal.yaw1\n1,5,0.01,0,0,0\n"),
             {"1:", "no column attach.yaw1"});
  check_says(refused(kHeader + "1,5,0.01,1e-3,0,0\n"), {"2:", "ragged row: 6 cells", "7"});
}

TEST(ModeTableFile, RefusesWhatNoModeCanBe) {
  check_says(refused(kHeader + "1,-5,0.01,1,1,0,0\n"), {"2:", "frequency[Hz] = \"-5\"", "above 0"});
  check_says(refused(kHeader + "1,5,1.5,1,1,0,0\n"), {"damping[1] = \"1.5\"", "below 1"});
  check_says(refused(kHeader + "1,5,0.01,nan,1,0,0\n"), {"attach.pitch1 = \"nan\"", "not a finite number"});
  check_says(refused(kHeader + "1,5,0.01,1,1,0,0\n\n1,6,0.01,1,1,0,0\n"), {"4:", "given twice"});
}

TEST(ModeTableFile, RefusesMoreEnginesThanTheBuildHas) {
  check_says(refused("mode,frequency[Hz],damping[1],attach.pitch5\n"), {"1:", "engine 5", "at most 4"});
  check_says(refused("mode,frequency[Hz],damping[1],attach.roll1\n"), {"attach.roll1", "unknown", "allowed"});
}

TEST(ModeTableFile, RefusesAResidualThatIsNoFlexibility) {
  const std::string rows =
      "residual.attach.yaw1,,,0,1e-9,0,0\nresidual.gimbal."
      "pitch1,,,0,0,1e-9,0\n";
  check_says(refused(kHeader + "residual.attach.pitch1,,,1e-9,0,0,0\n" + rows), {"no row residual.gimbal.yaw1"});
  const std::string last = "residual.gimbal.yaw1,,,0,0,0,1e-9\n";
  check_says(refused(kHeader + "residual.attach.pitch1,,,1e-9,5e-10,0,0\n" + rows + last), {"not symmetric"});
  check_says(refused(kHeader + "residual.attach.pitch1,,,-1e-9,0,0,0\n" + rows + last), {"positive semidefinite"});
  check_says(refused(kHeader + "residual.attach.roll1,,,1e-9,0,0,0\n"), {"no such port"});
}

}  // namespace hotfire::test
