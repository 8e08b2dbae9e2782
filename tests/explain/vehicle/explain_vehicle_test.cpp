// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "tests/explain/readings.hpp"
#include "tests/files/scratch.hpp"
#include "tools/explain/explain.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/synthetic.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;

constexpr double kPistonNoise = 8e-6;
constexpr double kEngineNoise = 6e-5;

/// Four engines on a structure that has most of the flexibility of the attach points in its modes.
VehicleFile vehicle_with(const std::string& more) {
  const test::Scratch scratch;
  scratch.write("modes.csv", mode_table_text(synthetic_vehicle(3, 40), {}));
  return load_vehicle(scratch.write("masv.toml",
                                    "schema = 1\ntopology = \"masv\"\n[structure]\nstiffness = 4e8\n[modes]\n"
                                    "table = \"modes.csv\"\n[sensors]\npiston_noise = 8e-6\nengine_noise = 6e-5\n" +
                                        more));
}

VehicleFile declared() {
  return vehicle_with("[tolerance]\nservovalve.position_gain = 0.03\nengine.inertia = 0.02\nstructure.stiffness = 0.1\n");
}

/// What the axes of a model measure under sines and steps of all commands, with sensor noise.
Record measured(const VehicleFile& model, const std::vector<std::string>& axes, double seconds) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  Record record;
  record.name = record.path = "all.csv";
  record.period = 2e-3;
  record.rows = static_cast<std::size_t>(seconds / record.period);
  for (const std::string& name : axis_names(4)) {
    std::vector<double> command(record.rows, 0.0);
    for (int line = 0; line < 8; ++line) {
      const double amplitude = 2e-3 + 2e-3 * uniform(random);
      const double turn = 2.0 * std::numbers::pi * 0.4 * std::pow(20.0, uniform(random));
      for (std::size_t row = 250; row < record.rows; ++row) {
        const double t = static_cast<double>(row - 250) * record.period;
        command[row] += amplitude * std::sin(turn * t);
      }
    }
    const auto every = static_cast<std::size_t>(1000.0 + 800.0 * uniform(random));
    for (std::size_t row = every; row < record.rows; ++row) {
      command[row] += row / every % 2 == 0 ? -5e-3 : 5e-3;
    }
    record.channels.push_back({"command." + name, "rad", command});
  }
  const Record simulated = simulate(model, record);
  std::vector<std::pair<std::string, double>> noise;
  for (const std::string& axis : axes) {
    noise.emplace_back("piston." + axis, kPistonNoise);
    noise.emplace_back("engine." + axis, kEngineNoise);
  }
  test::add_readings(record, simulated, noise, random);
  return record;
}

const char* const kDeadband = "[effects.valve_deadband.pitch2]\nhalf_width = 0.01\n";

std::map<std::string, std::string> names_by_axis(const explain::Result& result) {
  std::map<std::string, std::string> names;
  for (const explain::FoundEffect& effect : result.effects) {
    names[effect.axis] += effect.name;
  }
  return names;
}

}  // namespace

TEST_GROUP(ExplainVehicle){};
TEST_GROUP(ExplainVehicleAtLength){};

TEST(ExplainVehicle, an_axis_of_eight_is_explained_while_those_that_are_not_measured_are_simulated) {
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared(), {measured(vehicle_with(kDeadband), {"pitch2", "yaw2"}, 12.0)}, options);
  CHECK_TRUE(found.result.verdict == explain::Verdict::explained);
  CHECK_TRUE(names_by_axis(found.result) == (std::map<std::string, std::string>{{"pitch2", "valve_deadband"}}));
  // The text of the model is what the rig reads next.
  const std::string text = vehicle_text(found.model);
  STRCMP_CONTAINS("[effects.valve_deadband.pitch2]", text.c_str());
  for (const explain::ChannelErrors& channel : found.result.channels) {
    CHECK_COMPARE(channel.explained.rms, <, 1.15 * channel.noise);
  }
}

TEST(ExplainVehicleAtLength, of_eight_axes_the_two_with_a_missing_effect_are_named_and_no_other) {
  std::string effects(kDeadband);
  effects +=
      "[effects.soft_stiffness.yaw3]\nlaw = \"compliance\"\nlow_stiffness = 5.2e7\n"
      "load_scale = 6e3\n[structure.yaw4]\nstiffness = 4.4e8\n";
  const VehicleFile truth = vehicle_with(effects);
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared(), {measured(truth, axis_names(4), 131.0)}, options);
  CHECK_TRUE(names_by_axis(found.result) ==
             (std::map<std::string, std::string>{{"pitch2", "valve_deadband"}, {"yaw3", "soft_stiffness"}}));
  for (const explain::ChannelErrors& channel : found.result.channels) {
    CHECK_COMPARE(channel.explained.rms, <, 1.1 * channel.noise);
  }
  // The load stiffness of each attach point, with its interval.
  const auto stiffness =
      std::ranges::find(found.result.calibration, "structure.yaw4.stiffness", &explain::CalibratedParameter::key);
  CHECK_TRUE(stiffness != found.result.calibration.end());
  CHECK_TRUE(stiffness->interval.has_value());
  CHECK_COMPARE(stiffness->interval->first, <, 4.4e8);
  CHECK_COMPARE(stiffness->interval->second, >, 4.4e8);
}
