// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/response/condition.hpp"
#include "tools/response/response_report.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/port_response.hpp"
#include "tools/structure/reduction.hpp"
#include "tools/structure/synthetic.hpp"
#include "tools/trials/profiles.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::response {

namespace {

using Complex = std::complex<double>;

/// The complex amplitude of a channel at a frequency, over the last `rows` rows, which are whole periods.
Complex amplitude(const Record& record, const std::string& channel, double frequency, std::size_t rows) {
  const std::vector<double>& values = record.find(channel)->values;
  Complex sum = 0.0;
  for (std::size_t row = values.size() - rows; row < values.size(); ++row) {
    sum += values[row] * std::polar(1.0, -2.0 * std::numbers::pi * frequency * record.period * static_cast<double>(row));
  }
  return sum * 2.0 / static_cast<double>(rows);
}

}  // namespace

TEST_GROUP(Response) {
  test::Scratch scratch;

  /// One engine on a structure of two modes, all of it linear.
  std::filesystem::path taos() const {
    scratch.write("modes.csv",
                  "mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,gimbal.pitch1,gimbal.yaw1\n"
                  "1,6.0,0.02,2.5e-3,-1e-3,4e-4,2e-4\n2,11.0,0.03,-3e-3,2e-3,3e-4,-5e-4\n");
    return scratch.write(
        "taos.toml",
        "schema = 1\ntopology = \"taos\"\n[structure]\nstiffness = 1.5e8\n[gimbal]\nstiffness = [[2e9, 0, 0, 0, 0, "
        "0], [0, 1e9, 0, 0, 0, 0], [0, 0, 1e9, 0, 0, 0], [0, 0, 0, 2e7, 0, 0], [0, 0, 0, 0, 2e7, 0], [0, 0, 0, "
        "0, 0, 2e7]]\n[modes]\ntable = \"modes.csv\"\n");
  }
};

TEST(Response, AtRestIsTheStaticFlexibilityAndAForceAndItsMotionChangePlaces) {
  const ModeSet modes = synthetic_vehicle(3, 30);
  const Eigen::MatrixXcd at_rest = port_response(modes, 0.0);
  const Eigen::MatrixXd flexibility = static_flexibility(modes);
  CHECK((at_rest.real() - flexibility).norm() < 1e-12 * flexibility.norm());
  const Eigen::MatrixXcd response = port_response(modes, 9.0);
  CHECK((response - response.transpose()).norm() < 1e-12 * response.norm());
}

// phi^2 / (2 zeta w^2), a quarter of a period behind the force.
TEST(Response, OfOneModeAtItsResonanceIsThatOfItsDamping) {
  ModeSet modes = synthetic_vehicle(3, 30);
  for (int k = 1; k < modes.modes(); ++k) {
    modes.shape.col(k).setZero();
  }
  modes.residual.setZero();
  const double w = 2.0 * std::numbers::pi * modes.frequency(0);
  const Complex wanted(0.0, -modes.shape(0, 0) * modes.shape(0, 0) / (2.0 * modes.damping_ratio(0) * w * w));
  CHECK(std::abs(port_response(modes, modes.frequency(0))(0, 0) - wanted) < 1e-12 * std::abs(wanted));
}

TEST(Response, TheModalIntegralEndsAtTheLoadStiffnessOfTheModel) {
  const Condition condition = load_condition(taos(), {});
  for (int axis = 0; axis < 2; ++axis) {
    const StiffnessByFrequency own = load_stiffness_by_frequency(condition, axis);
    LONGS_EQUAL(3, own.stiffness.size());
    DOUBLES_EQUAL(1.5e8, own.stiffness.front(), 1e-6);
    CHECK(own.stiffness[0] > own.stiffness[1] && own.stiffness[1] > own.stiffness[2]);
    const double wanted = condition.axes[static_cast<std::size_t>(axis)].spring.load.load_stiffness;
    DOUBLES_EQUAL(wanted, own.stiffness.back(), 1e-9 * wanted);
  }
}

TEST(Response, OfABearingWithABlockIsThatOfItsHalvesInSeries) {
  const std::string taos_text =
      "schema = 1\ntopology = \"taos\"\n[gimbal]\nthrust = 1e5\nunloaded_stiffness = 0.5\nstiffness = "
      "[[2e9, 0, 0, 0, 0, 0], [0, 1e9, 0, 0, 0, 0], [0, 0, 1e9, 0, 0, 0], [0, 0, 0, 2e7, 0, 0], "
      "[0, 0, 0, 0, 2e7, 0], [0, 0, 0, 0, 0, 2e7]]\n";
  const Condition plain = load_condition(scratch.write("plain.toml", taos_text), {});
  const Condition blocked =
      load_condition(scratch.write("blocked.toml", taos_text + "block_mass = 50\nblock_inertia = 1\n"), {});
  CHECK((plain.bearing - blocked.bearing).norm() < 1e-9 * plain.bearing.norm());
}

// Without modes and bearing: a mass on two springs in series, whose resonance is that of eq. 10.
TEST(Response, OfARigidVehicleResonatesAtTheLoadResonance) {
  const Condition condition =
      load_condition(scratch.write("rigid.toml", "schema = 1\ntopology = \"taos\"\n[structure]\nstiffness = 6e7\n"), {});
  const ConditionAxis& axis = condition.axes.front();
  double best = 0.0;
  double at = 0.0;
  for (double frequency = 0.5 * axis.stiffness.frequency; frequency < 1.5 * axis.stiffness.frequency; frequency += 0.002) {
    const double size = std::abs(actuator_response(condition, frequency).motion(0, 0));
    at = size > best ? frequency : at;
    best = std::max(best, size);
  }
  // The engine's damping moves the peak by the square of its ratio, less than the grid.
  DOUBLES_EQUAL(axis.stiffness.frequency, at, 0.01);
}

// The plant in time against the equations in frequency: a piston that moves by x is a force K_act x. Both axes move, since
// modes and bearing couple them. The plant's step of 1 ms at 9 Hz is 1/111 of a period.
TEST(Response, OfTheEnginesIsThatOfThePlantWhichARigRuns) {
  const std::filesystem::path path = taos();
  const Condition condition = load_condition(path, {});
  const VehicleFile vehicle = load_vehicle(path);
  for (const double frequency : {2.0, 5.0, 8.0, 12.0}) {
    constexpr std::size_t kRows = 20'000;
    std::vector<double> command(kRows);
    for (std::size_t row = 0; row < kRows; ++row) {
      command[row] = 1e-4 * std::sin(2.0 * std::numbers::pi * frequency * 1e-3 * static_cast<double>(row));
    }
    const Record record = simulate(vehicle, trials::command_record(std::move(command), "command.pitch"));
    const ActuatorResponse response = actuator_response(condition, frequency);
    const char* names[] = {"pitch", "yaw"};
    for (Eigen::Index angle = 0; angle < 2; ++angle) {
      Complex wanted = 0.0;
      for (Eigen::Index piston = 0; piston < 2; ++piston) {
        wanted += response.angle(angle, piston) * condition.axes[static_cast<std::size_t>(piston)].stiffness.actuator *
                  amplitude(record, std::string("piston.") + names[piston], frequency, 10'000);
      }
      const Complex found = amplitude(record, std::string("engine.") + names[angle], frequency, 10'000);
      const double size = std::abs(amplitude(record, "engine.pitch", frequency, 10'000));
      CHECK(std::abs(found) > 1e-3 * size);
      DOUBLES_EQUAL(0.0, std::abs(found - wanted) / size, 0.01);
    }
  }
}

TEST(Response, AMeasuredResonanceGivesBackTheLoadStiffnessThatMakesIt) {
  Comparison comparison{{load_condition(taos(), {})}, {}, {5.0, 10.0}};
  const ConditionAxis& axis = comparison.conditions.front().axes.front();
  comparison.measured = load_measured(scratch.write("measured.csv", "# by test\ncondition,axis,resonance[Hz]\ntaos,pitch," +
                                                                        std::to_string(axis.stiffness.frequency) + "\n"));
  require_known(comparison);
  const nlohmann::ordered_json own = to_json(comparison, true)["conditions"][0]["axes"][0];
  const double load = axis.spring.load.load_stiffness;
  // Six decimals of a frequency, twice as much of the total and as much again of the load.
  DOUBLES_EQUAL(load, own["measured_load_stiffness"].get<double>(), 1e-5 * load);
  LONGS_EQUAL(5, pictures_of(comparison).size());
  STRCMP_CONTAINS("taos.attach.pitch1[m/N]", table_of(comparison).c_str());
}

TEST(Response, AModeTableAloneHasItsPortsAndNoEngines) {
  taos();
  const Comparison comparison{{load_condition(scratch.path("modes.csv"), {})}, {}, {5.0, 10.0}};
  LONGS_EQUAL(2, pictures_of(comparison).size());
  STRCMP_CONTAINS("attach.yaw1: load ", text_of(comparison).c_str());
}

TEST(Response, WhatCannotBeComparedIsRefused) {
  const auto measured = [&](const std::string& text) {
    const auto path = scratch.write("measured.csv", text);
    return test::refusal([&] { load_measured(path); });
  };
  test::expect_message(measured("condition,axis,hertz\n"), {"measured.csv:1:", "condition,axis,resonance[Hz]"});
  test::expect_message(measured("condition,axis,resonance[Hz]\na,pitch,x\n"), {"measured.csv:2:", "above 0"});
  test::expect_message(measured("condition,axis,resonance[Hz]\na,pitch\n"), {"measured.csv:2:", "three cells"});
  const auto simplex = scratch.write("one.toml", "schema = 1\ntopology = \"simplex\"\n");
  test::expect_message(test::refusal([&] { load_condition(simplex, {}); }), {"one.toml", "taos", "masv"});
  Comparison comparison{{load_condition(taos(), {})}, {{"taoss", "pitch", 7.0}}, {5.0}};
  CHECK_THROWS(UsageError, require_known(comparison));
  comparison.measured = {{"taos", "roll", 7.0}};
  CHECK_THROWS(UsageError, require_known(comparison));
}

}  // namespace hotfire::response
