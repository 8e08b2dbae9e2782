// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/explain/explain.hpp"
#include "tools/explain/report/report_json.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/study/cases/case.hpp"
#include "tools/study/draws/random.hpp"

namespace hotfire::study {
namespace {

constexpr double kPeriod = 4e-3;
constexpr std::size_t kRows = 5000;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Sines from 0.4 to 8 Hz, each of up to a quarter of a degree, and steps between; starts at zero.
std::vector<double> commands(std::uint64_t seed) {
  Random random("two axes", seed);
  std::vector<double> angle(kRows, 0.0);
  for (int line = 0; line < 8; ++line) {
    const double amplitude = random.uniform(0.1, 0.25) * kDegree;
    const double turn = 2.0 * std::numbers::pi * random.log_uniform(0.4, 8.0);
    for (std::size_t i = 0; i < kRows; ++i) {
      angle[i] += amplitude * std::sin(turn * kPeriod * static_cast<double>(i));
    }
  }
  const std::size_t every = kRows / 7;
  for (std::size_t i = every; i < kRows; ++i) {
    angle[i] += (i / every % 2 == 0 ? -0.3 : 0.3) * kDegree;
  }
  return angle;
}

/// What the two axes of an engine do, by the independent simulator.
Record recorded(const std::array<ReferenceAxis, 2>& axes, std::uint64_t seed, double noise_factor) {
  std::array<std::vector<double>, 2> driven{commands(seed), commands(seed + 100)};
  // The simulator reads a row at the end of its command.
  std::array<std::vector<double>, 2> later;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    later[axis].assign(driven[axis].begin(), driven[axis].end() - 1);
    later[axis].insert(later[axis].begin(), 0.0);
  }
  const auto rows = integrate_reference_pair(axes, later, kPeriod, 2.0, 1e-8);
  Random random("noise of two axes", seed);
  Record record;
  record.path = record.name = "both.csv";
  record.period = kPeriod;
  record.rows = kRows;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string name = axis == 0 ? ".pitch" : ".yaw";
    record.channels.push_back({"command" + name, "rad", driven[axis]});
    for (std::size_t c = 0; c < 2; ++c) {
      Channel channel{kSensorGrades[c].channel + name, kSensorGrades[c].unit, {}};
      for (const auto& row : rows[axis]) {
        channel.values.push_back(row[c] + noise_factor * kSensorGrades[c].noise * random.normal());
      }
      record.channels.push_back(std::move(channel));
    }
  }
  return record;
}

const char* const kDeclared =
    "schema = 1\ntopology = \"taos\"\n[sensors]\npiston_noise = 8e-6\nengine_noise = 6e-5\n[tolerance]\n"
    "servovalve.position_gain = 0.03\nengine.inertia = 0.02\nstructure.stiffness = 0.05\nengine.viscous_damping = 0.3\n";

double largest_error(const VehicleFile& model, const Record& truth) {
  const Record modelled = simulate(model, truth);
  double largest = 0.0;
  for (const SensorGrade& grade : {kSensorGrades[0], kSensorGrades[1]}) {
    for (const char* axis : {".pitch", ".yaw"}) {
      const std::vector<double>& a = modelled.find(grade.channel + std::string(axis))->values;
      const std::vector<double>& b = truth.find(grade.channel + std::string(axis))->values;
      double sum = 0.0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
      }
      largest = std::max(largest, std::sqrt(sum / static_cast<double>(a.size())) / grade.noise);
    }
  }
  return largest;
}

}  // namespace

TEST_GROUP(TwoAxes) { test::Scratch scratch; };

TEST(TwoAxes, TorqueFromTheOtherAxisIsFoundOnTheAxisThatFeelsIt) {
  std::array<ReferenceAxis, 2> axes;
  axes[0].inertia *= 1.01;
  axes[1].position_gain *= 0.98;
  axes[1].cross_stiffness = 6e5;
  const VehicleFile declared = load_vehicle(scratch.write("declared.toml", kDeclared));
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared, {recorded(axes, 1, 1.0)}, options);

  LONGS_EQUAL(1, found.result.effects.size());
  const explain::FoundEffect& effect = found.result.effects.front();
  STRCMP_EQUAL("cross_axis", effect.name.c_str());
  STRCMP_EQUAL("yaw", effect.axis.c_str());
  CHECK_TRUE(found.result.verdict == explain::Verdict::explained);
  // Four standard deviations and a little are two 95 % intervals.
  const auto stiffness = std::ranges::find(effect.parameters, "stiffness", &explain::EffectParameter::name);
  const double half = stiffness->interval.value().second - stiffness->value;
  DOUBLES_EQUAL(6e5, stiffness->value, 2.0 * half);
  const nlohmann::json report = explain::report_json(found.result);
  CHECK_TRUE(report.at("calibration").contains("servovalve.yaw.position_gain"));
  CHECK_TRUE(report.at("channels").contains("engine.yaw"));

  // Its text is what the next tool reads; on commands that it has not seen it is closer to the truth than the sensors.
  const VehicleFile written = load_vehicle(scratch.write("explained.toml", vehicle_text(found.model)));
  CHECK_TRUE(largest_error(written, recorded(axes, 2, 0.0)) < 1.0);
}

TEST(TwoAxes, NothingIsFoundWhereNothingIsMissing) {
  std::array<ReferenceAxis, 2> axes;
  axes[0].damping *= 1.2;
  axes[1].load_stiffness *= 0.97;
  const VehicleFile declared = load_vehicle(scratch.write("declared.toml", kDeclared));
  explain::ExplainOptions options;
  options.kept_back = {recorded(axes, 2, 0.0)};
  const auto found = explain::explain(declared, {recorded(axes, 3, 1.0)}, options);
  CHECK_TRUE(found.result.verdict == explain::Verdict::nothing_missing);
  LONGS_EQUAL(0, found.result.effects.size());
  // On a record without noise that was held out whole the model of both axes is closer to the truth than the sensors.
  const std::vector<explain::ChannelErrors>& channels = found.result.held_out_records.at(0).channels;
  std::multiset<std::string> names;
  for (const explain::ChannelErrors& judged : channels) {
    names.insert(judged.name);
    CHECK_TRUE(judged.explained.rms < judged.noise);
    CHECK_TRUE(judged.explained.rms < judged.declared.rms);
  }
  CHECK_TRUE(names == (std::multiset<std::string>{"piston.pitch", "engine.pitch", "piston.yaw", "engine.yaw"}));
}

TEST(TwoAxes, WhatExplainDoesNotTakeIsRefusedWithTheRemedy) {
  const Record none;
  const auto refused = [&](const std::string& text) {
    const VehicleFile model = load_vehicle(scratch.write("model.toml", text));
    return test::refusal([&] { static_cast<void>(explain::explain(model, {none}, {})); });
  };
  const std::string taos = "schema = 1\ntopology = \"taos\"\n";
  test::expect_message(
      refused(taos +
              "[gimbal.friction]\nlaw = \"lugre\"\ncoulomb_torque = 1e4\n[gimbal.vibration]\npitch_velocity = 0.05\n"),
      {"gimbal.vibration", "vibrated_lugre"});
  test::expect_message(refused(taos + "[attach.pitch]\nengine_z = -0.7\n[tolerance]\nactuator.moment_arm = 0.01\n"),
                       {"actuator.moment_arm", "[attach]"});
  test::expect_message(refused(taos + "[sensors.piston]\nlag = 2e-3\n"), {"sensors.piston.lag", "effects.sensor_lag"});
  test::expect_message(refused(taos), {"command.pitch"});
}

}  // namespace hotfire::study
