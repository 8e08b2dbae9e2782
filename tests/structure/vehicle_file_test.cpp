// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/vehicle_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/keys.hpp"
#include "tests/model/support/plants.hpp"
#include "tests/structure/vehicle_texts.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/mode_table.hpp"
#include "tools/structure/synthetic.hpp"

namespace hotfire::test {
namespace {

std::string matrix(double diagonal, double corner, double other_corner) {
  std::string text = "stiffness = [";
  for (int row = 0; row < 6; ++row) {
    text.append("[");
    for (int column = 0; column < 6; ++column) {
      const double cell = row == column             ? diagonal
                          : row == 1 && column == 5 ? corner
                          : row == 5 && column == 1 ? other_corner
                                                    : 0.0;
      text.append(fmt::format("{}{:.1f}", column == 0 ? "" : ", ", cell));
    }
    text.append("],\n");
  }
  return text + "]\n";
}

/// Every number of an axis that a fit may move, and the choices of its effects.
template <class Axis>
std::vector<double> numbers_of(const Axis& axis) {
  std::vector<double> numbers;
  model::visit_values(axis, [&](const double& value) { numbers.push_back(value); });
  model::visit_effects(axis, [&]<class E>(std::size_t, const auto& values) { numbers.push_back(values.option); });
  return numbers;
}

/// Every number of a part.
template <class Part>
std::vector<double> numbers_of_part(const Part& part) {
  std::vector<double> numbers;
  for (const auto& field : Part::fields()) {
    numbers.push_back(part.*field.member);
  }
  return numbers;
}

void check_same(const VehicleSensors& a, const VehicleSensors& b) {
  CHECK_TRUE(numbers_of_part(a.piston) == numbers_of_part(b.piston));
  CHECK_TRUE(numbers_of_part(a.string) == numbers_of_part(b.string));
  DOUBLES_EQUAL(a.placement_error, b.placement_error, 0.0);
  LONGS_EQUAL(a.strings.size(), b.strings.size());
  for (std::size_t engine = 0; engine < a.strings.size(); ++engine) {
    for (std::size_t string = 0; string < VehicleSensors::Strings::kStrings; ++string) {
      CHECK_TRUE(numbers_of_part(a.strings[engine][string]) == numbers_of_part(b.strings[engine][string]));
    }
  }
}

/// A record with command channels.
Record commands(const std::vector<std::string>& names, double value) {
  Record record;
  record.path = record.name = "commands";
  record.period = 1e-3;
  record.rows = 200;
  for (const std::string& name : names) {
    record.channels.push_back({name, "rad", std::vector<double>(record.rows, value)});
  }
  return record;
}

}  // namespace

TEST_GROUP_BASE(VehicleFile, VehicleTexts){};

TEST(VehicleFile, GivesEveryAxisWhatIsSaidOfAllAndThenWhatIsSaidOfIt) {
  const auto masv = std::get<MasvParameters>(load(kMasv + "[actuator]\nstiffness = 9e7\nleakage = "
                                                          "1e-12\n[actuator.pitch]\nleakage = "
                                                          "3e-12\n[actuator.yaw2]\nleakage = "
                                                          "5e-12\n[effects.soft_stiffness]\nlaw = "
                                                          "\"compliance\"\nlow_stiffness = 5e7\n")
                                                 .parameters);
  for (std::size_t i = 0; i < 8; ++i) {
    DOUBLES_EQUAL(9e7, masv.axes[i].actuator.stiffness, 0.0);
    DOUBLES_EQUAL(i % 2 == 0 ? 3e-12 : i == 3 ? 5e-12 : 1e-12, masv.axes[i].actuator.leakage, 0.0);
  }
}

TEST(VehicleFile, PutsAnEffectOnEveryAxisOrOnThoseThatItsTablesName) {
  const auto taos = std::get<TaosParameters>(
      load(kTaos + "[effects.duct_hardening]\ncubic = 1e7\n[effects.duct_hardening.yaw]\ncubic = 2e7\n"
                   "[effects.cross_axis.pitch]\nstiffness = 3e5\n"
                   "[effects.gimbal_friction]\nlaw = \"lugre\"\ncoulomb_torque = 4e3\n[effects.gimbal_friction.yaw]\n"
                   "coulomb_torque = 6e3\n")
          .parameters);
  constexpr std::size_t kHardening = index_in<model::DuctHardening>(model::SimplexEffects{});
  constexpr std::size_t kCross = index_in<model::CrossAxis>(model::SimplexEffects{});
  constexpr std::size_t kFriction = index_in<model::GimbalFriction>(model::SimplexEffects{});
  const auto& pitch = taos.axes[0].effects;
  const auto& yaw = taos.axes[1].effects;
  CHECK_TRUE(pitch.active[kHardening] && yaw.active[kHardening]);
  DOUBLES_EQUAL(1e7, std::get<kHardening>(pitch.values).cubic, 0.0);
  DOUBLES_EQUAL(2e7, std::get<kHardening>(yaw.values).cubic, 0.0);
  CHECK_TRUE(pitch.active[kCross] && !yaw.active[kCross]);
  DOUBLES_EQUAL(3e5, std::get<kCross>(pitch.values).stiffness, 0.0);
  // The law was said of both axes: the table of one need not say it again.
  LONGS_EQUAL(std::get<kFriction>(pitch.values).option, std::get<kFriction>(yaw.values).option);
  DOUBLES_EQUAL(6e3, std::get<kFriction>(yaw.values).coulomb_torque, 0.0);
}

TEST(VehicleFile, GivesEveryAxisItsNoiseAndTolerances) {
  const VehicleFile taos = load(kTaos +
                                "[sensors]\npiston_noise = 8e-6\n[sensors.yaw]\npiston_noise = 9e-6\n"
                                "[tolerance]\nengine.inertia = 0.02\nengine.yaw.inertia = 0.05\n");
  DOUBLES_EQUAL(8e-6, taos.axes[0].noise.at("piston"), 0.0);
  DOUBLES_EQUAL(9e-6, taos.axes[1].noise.at("piston"), 0.0);
  DOUBLES_EQUAL(0.02, taos.axes[0].tolerance.at("engine.inertia"), 0.0);
  DOUBLES_EQUAL(0.05, taos.axes[1].tolerance.at("engine.inertia"), 0.0);
  expect_message(refused(kTaos + "[tolerance]\nengine.roll.inertia = 0.02\n"), {"v.toml:4:", "engine.roll.inertia"});
  expect_message(refused(kTaos + "[sensors.pitch]\nengin_noise = 1e-5\n"), {"v.toml:4:", "sensors.pitch.engin_noise"});
}

// Everything a file can say, some of it of one axis only.
// `piston` is a channel in the key of a noise and a sensor as a table: the two don't get in each other's way.
TEST(VehicleFile, HasTheNoiseOfItsRecordsAndTheSensorsOfItsSimulationInOneTable) {
  const std::string noise = "[sensors]\npiston_noise = 8e-6\n[sensors.pitch]\npiston_noise = 9e-6\n";
  const std::string sensor = "[sensors.piston]\nnoise = 2e-5\n";
  for (const std::string& text : {kTaos + noise + sensor, kTaos + sensor + noise}) {
    const VehicleFile both = load(text);
    DOUBLES_EQUAL(9e-6, both.axes[0].noise.at("piston"), 0.0);
    DOUBLES_EQUAL(8e-6, both.axes[1].noise.at("piston"), 0.0);
    DOUBLES_EQUAL(2e-5, both.sensors.piston.noise, 0.0);
  }
  LONGS_EQUAL(0, load(kTaos + sensor).axes[0].noise.size());
  DOUBLES_EQUAL(0.0, load(kTaos + noise).sensors.piston.noise, 0.0);
  expect_message(refused(kTaos + "[sensors.pitch.piston]\nnoise = 2e-5\n"), {"v.toml:3:", "sensors.pitch.piston"});
  expect_message(refused(kTaos + "[sensors]\npiston = 2e-5\n"), {"v.toml:4:", "sensors.piston"});
}

TEST(VehicleFile, IsReadBackBitForBitFromItsText) {
  const std::vector<std::string> texts{
      kTaos +
          "name = \"a \\\"test\\\"\"\n[actuator]\nmoment_arm = \"29.7 in\"\n[actuator.yaw]\nmoment_arm = 0.8\n"
          "[sensors]\npiston_noise = 8e-6\n[sensors.yaw]\nengine_noise = 6e-5\n"
          "[tolerance]\nengine.inertia = 0.02\nengine.yaw.inertia = 0.05\nservovalve.yaw.position_gain = 0.1\n"
          "[effects.cross_axis]\nstiffness = 3e5\n[effects.cross_axis.yaw]\nstiffness = -3e5\n"
          "[effects.soft_stiffness.yaw]\nlaw = \"table\"\nload = [0, 1e4]\ntable_stiffness = [4e7, 1.1e8]\n"
          "[sensors.piston]\nlag = 2e-3\nstep = 5e-6\n",
      kMasv + "[attach.pitch]\nengine_z = -0.8\nvehicle_z = -0.8\n[gimbal]\nthrust = 1.86e6\n" + matrix(2e7, 1e6, 1e6) +
          "[gimbal.friction]\nlaw = \"lugre\"\ncoulomb_torque = 2e4\n[effects.torque_offset.pitch2]\ntorque = 1e3\n"
          "[strings]\nlag = 2e-3\nplacement_error = 0.02\n[strings.string2]\nengine_z = 0.7\n"
          "[strings.string2.engine3]\nengine_z = 0.8\n"};
  for (const std::string& written : texts) {
    const VehicleFile first = load(written);
    const std::string text = vehicle_text(first);
    const VehicleFile again = load(text);
    STRCMP_EQUAL(text.c_str(), vehicle_text(again).c_str());
    check_same(first.sensors, again.sensors);
    std::visit(
        [&]<class Parameters>(const Parameters& parameters) {
          const auto& others = std::get<Parameters>(again.parameters);
          for (std::size_t axis = 0; axis < parameters.axes.size(); ++axis) {
            CHECK_TRUE(numbers_of(parameters.axes[axis]) == numbers_of(others.axes[axis]));
            CHECK_TRUE(parameters.axes[axis].effects.active == others.axes[axis].effects.active);
            CHECK_TRUE(first.axes[axis].noise == again.axes[axis].noise);
            CHECK_TRUE(first.axes[axis].tolerance == again.axes[axis].tolerance);
          }
          CHECK_TRUE(parameters.constant_arms == others.constant_arms);
          CHECK_TRUE(parameters.gimbals[0].stiffness == others.gimbals[0].stiffness);
          DOUBLES_EQUAL(parameters.gimbals[0].friction.coulomb_torque, others.gimbals[0].friction.coulomb_torque, 0.0);
        },
        first.parameters);
  }
}

// physics.md section 1 for each axis, where no attach points are given.
TEST(VehicleFile, WithoutAttachPointsHasTheDeclaredArmsAtAnyAngle) {
  const VehicleFile taos = load(kTaos + "[actuator]\nmoment_arm = 0.6\n[actuator.yaw]\nmoment_arm = 0.9\n");
  DOUBLES_EQUAL(0.6, moment_arm_of(taos, "pitch"), 0.0);
  DOUBLES_EQUAL(0.9, moment_arm_of(taos, "yaw"), 0.0);
  Record run = commands({"command.pitch", "command.yaw"}, 0.0);
  run.rows = 2000;
  run.channels[0].values.assign(run.rows, 0.1);
  run.channels[1].values.assign(run.rows, 0.05);
  const Record record = simulate(taos, run);
  // At rest the piston is where the command has it but for the valve's leakage flow, a thousandth.
  DOUBLES_EQUAL(0.06, record.find("piston.pitch")->values.back(), 1e-4);
  DOUBLES_EQUAL(0.045, record.find("piston.yaw")->values.back(), 1e-4);
}

TEST(VehicleFile, ReadsTheBearingAndItsAttachPoints) {
  const auto taos =
      std::get<TaosParameters>(load(kTaos +
                                    "[attach.pitch]\nengine_z = -0.8\nvehicle_z = "
                                    "-0.8\n[gimbal]\nthrust = 1.86e6\n" +
                                    matrix(2e7, 1e6, 1e6) + "[gimbal.friction]\nlaw = \"lugre\"\ncoulomb_torque = 2e4\n")
                                   .parameters);
  CHECK_TRUE(taos.gimbals[0].compliant);
  DOUBLES_EQUAL(1e6, taos.gimbals[0].stiffness(5, 1), 0.0);
  DOUBLES_EQUAL(1.86e6, taos.gimbals[0].bearing.thrust, 0.0);
  DOUBLES_EQUAL(2e4, taos.gimbals[0].friction.coulomb_torque, 0.0);
  DOUBLES_EQUAL(-0.8, taos.attach[0].engine_z, 0.0);
  CHECK_FALSE(std::get<TaosParameters>(load(kTaos).parameters).gimbals[0].compliant);
}

TEST(VehicleFile, ReadsItsModesFromTheTableBesideIt) {
  scratch.write("modes.csv", mode_table_text(synthetic_vehicle(3, 20), {}));
  const auto masv = std::get<MasvParameters>(load(kMasv + "[modes]\ntable = \"modes.csv\"\n").parameters);
  LONGS_EQUAL(20, masv.modes.modes);
  CHECK_TRUE(masv.modes.frequency[0] > 0.0 && masv.modes.frequency[20] == 0.0);
}

TEST(VehicleFile, IsShippedAsAnExampleThatRuns) {
  const VehicleFile shipped = load_vehicle(HOTFIRE_SOURCE_DIR "/docs/samples/taos.toml");
  const Record run = simulate(shipped, commands({"command.pitch"}, 0.01));
  // Held by friction and ducts at its start, and by nothing else.
  DOUBLES_EQUAL(0.01, run.find("engine.pitch")->values.back(), 2e-3);
  CHECK_TRUE(run.find("string4") != nullptr);
}

TEST(VehicleFile, IsRefusedWithWhatAndWhere) {
  expect_message(refused(kTaos + "[gimbal]\n" + matrix(2e7, 1e6, 2e6)),
                 {"v.toml:4:13:", "gimbal.stiffness", "not symmetric"});
  expect_message(refused(kTaos + "[gimbal]\n" + matrix(2e7, 3e7, 3e7)),
                 {"v.toml:4:", "gimbal.stiffness", "positive definite"});
  expect_message(refused(kTaos + "[gimbal]\nblock_mass = 50\nblock_inertia = 1\n"),
                 {"v.toml:3:", "gimbal", "rigid bearing", "give gimbal.stiffness"});
  expect_message(refused(kTaos + "[gimbal]\nblock_mass = 50\n" + matrix(2e7, 1e6, 1e6)),
                 {"v.toml:3:", "gimbal", "give block_mass and block_inertia"});
  expect_message(refused(kTaos + "[gimbal]\nblock_inertia = -1\n"), {"v.toml:4:", "gimbal.block_inertia", "0 to 100000"});
  expect_message(refused(kTaos + "[gimbal]\nstiffness = [[1, 2], [2, 1]]\n"), {"v.toml:4:", "gimbal.stiffness", "six rows"});
  expect_message(refused(kTaos + "[attach.pitch]\nengine_x = 0.9\n"), {"v.toml:", "attach", "coincide"});
  expect_message(refused(kTaos + "[attach.yaw]\nengine_y = \"-0.7544 "
                                 "m\"\nvehicle_y = \"-0.7544 m\"\n"),
                 {"v.toml:", "attach", "no arm"});
  expect_message(refused(kTaos + "[actuator.roll]\nleakage = 1\n"), {"v.toml:3:", "actuator.roll", "pitch"});
  expect_message(refused(kTaos + "[actuator.pitch2]\nleakage = 1\n"), {"v.toml:3:", "actuator.pitch2", "unknown key"});
  expect_message(refused(kTaos + "[actuator.pitch]\nleakage = -1\n"),
                 {"v.toml:4:", "actuator.pitch.leakage", "allowed: 0 to"});
  expect_message(refused(kTaos + "[gimbal.friction]\nlaw = \"lugra\"\n"), {"v.toml:4:", "gimbal.friction.law", "lugre"});
  expect_message(refused(kTaos + "[gimbal.vibration]\npitch_velocity = "
                                 "0.1\n[gimbal.friction]\nlaw = \"vibrated_lugre\"\n"
                                 "coulomb_torque = 1e4\n"),
                 {"v.toml:", "gimbal", "two ways to the same physics"});
  expect_message(refused(kTaos + "[engines]\n"), {"v.toml:3:", "engines", "unknown key"});
}

TEST(VehicleFile, RefusesModesThatItHasNoRoomFor) {
  scratch.write("many.csv", mode_table_text(synthetic_vehicle(3, 65), {}));
  expect_message(refused(kMasv + "[modes]\ntable = \"many.csv\"\n"), {"v.toml:4:", "65 modes", "at most 64", "reduce"});
  expect_message(refused(kTaos + "[modes]\ntable = \"many.csv\"\n"), {"v.toml:4:", "4 engines", "allowed: 1"});
  expect_message(refused(kMasv + "[modes]\ntable = \"none.csv\"\n"), {"none.csv"});
  scratch.write("short.csv",
                "mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,"
                "gimbal.pitch1,gimbal.yaw1\n1,-4,0.01,1,1,0,0\n");
  expect_message(refused(kTaos + "[modes]\ntable = \"short.csv\"\n"), {"short.csv:2:", "-4"});
  expect_message(refused(kTaos + "[modes]\n"), {"v.toml:3:", "modes.table", "missing"});
}

TEST(VehicleFile, RunsOnTheCommandsOfItsAxes) {
  const VehicleFile taos = load(kTaos);
  const Record run = simulate(taos, commands({"command.pitch"}, 0.01));
  LONGS_EQUAL(8, run.channels.size());
  // In the steady state under the first row: pitch stands where it is
  // commanded, but for the ducts' load, and yaw at zero.
  DOUBLES_EQUAL(0.01, run.find("engine.pitch")->values.back(), 3e-4);
  DOUBLES_EQUAL(0.0, run.find("engine.yaw")->values.back(), 1e-4);
  CHECK_TRUE(run.find("command.yaw")->values == std::vector<double>(200, 0.0));
  DOUBLES_EQUAL(0.7544, moment_arm_of(taos, "pitch"), 1e-9);
  expect_message(refusal([&] { simulate(taos, commands({"command.pitch3"}, 0.0)); }), {"command.pitch3", "pitch, yaw"});
  expect_message(refusal([&] { simulate(taos, commands({"vibration"}, 0.0)); }), {"no column command.pitch"});
}

// Vibration takes friction away, so that a small step gets further; a law that
// has that already does not take it twice.
TEST(VehicleFile, AddsARecordedVibrationToTheSlipOfItsBearing) {
  const std::string friction = kTaos + "[gimbal.friction]\ncoulomb_torque = 15e3\nstiffness = 1e8\nlaw = ";
  const VehicleFile taos = load(friction + "\"lugre\"\n");
  Record inputs = commands({"command.pitch", "vibration.pitch"}, 0.004);
  std::vector<double>& command = inputs.channels[0].values;
  std::fill(command.begin(), command.begin() + 20, 0.0);
  std::vector<double>& vibration = inputs.channels[1].values;
  const auto reached = [&](double amplitude) {
    for (std::size_t row = 0; row < inputs.rows; ++row) {
      vibration[row] = amplitude * std::sin(600.0 * static_cast<double>(row) * inputs.period);
    }
    return simulate(taos, inputs).find("engine.pitch")->values.back();
  };
  CHECK_TRUE(reached(0.05) > 1.02 * reached(0.0));
  const VehicleFile lowered = load(friction + "\"vibrated_lugre\"\n");
  expect_message(refusal([&] { simulate(lowered, inputs); }), {"vibration.pitch", "two ways to the same physics"});
  inputs.channels[1].name = "vibration.yaw3";
  expect_message(refusal([&] { simulate(taos, inputs); }), {"vibration.yaw3", "no such axis"});
}

// A constant torque turns the engine by what the springs give, towards positive angles.
TEST(VehicleFile, IsTurnedByARecordedTorque) {
  const VehicleFile taos = load(kTaos);
  Record inputs = commands({"command.pitch", "torque.pitch"}, 0.0);
  std::fill(inputs.channels[1].values.begin(), inputs.channels[1].values.end(), 5e3);
  const Record turned = simulate(taos, inputs);
  CHECK_TRUE(turned.find("engine.pitch")->values.back() > 1e-5);
  DOUBLES_EQUAL(0.0, turned.find("engine.yaw")->values.back(), 1e-5);
  inputs.channels[1].name = "torque.yaw3";
  expect_message(refusal([&] { simulate(taos, inputs); }), {"torque.yaw3", "no such axis"});
  inputs.channels[1].name = "force.w";
  expect_message(refusal([&] { simulate(taos, inputs); }), {"force.w", "x, y, z"});
}

// Thrust of a file, of a switch and of an input are the same thing.
TEST(VehicleFile, HasTheThrustOfItsInputInPlaceOfItsOwn) {
  const std::string text = kTaos +
                           "[gimbal]\nthrust = 1.86e6\nrated_thrust = 1.86e6\nunloaded_structure = 0.4\n"
                           "[gimbal.friction]\nlaw = \"lugre\"\ncoefficient = 0.08\nstiffness = 1e8\n";
  const VehicleFile taos = load(text);
  Record inputs = commands({"command.pitch", "thrust"}, 0.004);
  std::vector<double>& thrust = inputs.channels[1].values;
  std::fill(inputs.channels[0].values.begin(), inputs.channels[0].values.begin() + 20, 0.0);
  const auto reached = [](const Record& record) { return record.find("engine.pitch")->values; };
  for (const double own : {0.0, 0.5e6}) {
    std::fill(thrust.begin(), thrust.end(), own);
    const std::vector<double> put_in = reached(simulate(taos, inputs));
    const Record of_command = [&] {
      Record plain = inputs;
      plain.channels.pop_back();
      return plain;
    }();
    const std::vector<double> same = reached(simulate(with_thrust(taos, own), of_command));
    for (std::size_t row = 0; row < put_in.size(); ++row) {
      DOUBLES_EQUAL(same[row], put_in[row], 1e-9);
    }
    CHECK_TRUE(reached(simulate(taos, of_command)) != same);
  }
  thrust[7] = -1.0;
  expect_message(refusal([&] { simulate(taos, inputs); }), {"row 8", "thrust", "-1", "0 to 1e+08 N"});
  CHECK_THROWS(UsageError, with_thrust(taos, -2.0));
}

}  // namespace hotfire::test
