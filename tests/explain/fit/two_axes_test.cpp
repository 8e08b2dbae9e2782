// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/two_axes.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tools/explain/explain.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;

constexpr double kPistonNoise = 8e-6;
constexpr double kEngineNoise = 6e-5;

/// Two axes on inclined attach points, so that a torque about one of them moves the other.
VehicleFile model_with(const std::string& inertia, const std::string& more = "") {
  return parse_vehicle(
      "schema = 1\ntopology = \"taos\"\n[engine]\ninertia = " + inertia +
          "\n[sensors]\npiston_noise = 8e-6\nengine_noise = 6e-5\n[tolerance]\nengine.inertia = 0.05\n"
          "[attach.pitch]\nengine_x = -0.35\nengine_y = 0.05\nengine_z = -0.70\nvehicle_x = 0.85\nvehicle_y = 0.0\n"
          "vehicle_z = -0.95\n[attach.yaw]\nengine_x = -0.35\nengine_y = 0.70\nengine_z = 0.05\nvehicle_x = 0.85\n"
          "vehicle_y = 0.95\nvehicle_z = 0.0\n" +
          more,
      "taos.toml");
}

/// 12 s of both commands and of a measured torque of each of `torques`, read from a model with sensor noise.
Record record_under(const std::array<double, 2>& torques) {
  Record record;
  record.name = record.path = "both.csv";
  record.period = 2e-3;
  record.rows = 6000;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string name = axis == 0 ? "pitch" : "yaw";
    Channel command{"command." + name, "rad", {}};
    Channel torque{"torque." + name, "N.m", {}};
    for (std::size_t row = 0; row < record.rows; ++row) {
      const double t = static_cast<double>(row) * record.period;
      const double turn = 2.0 * std::numbers::pi * t;
      const double on = t < 0.5 ? 0.0 : 1.0;
      command.values.push_back(on * 4e-3 * std::sin(turn * (axis == 0 ? 0.3 + 0.1 * t : 1.4)));
      torque.values.push_back(on * torques[axis] * std::sin(turn * (axis == 0 ? 2.3 : 3.1)));
    }
    record.channels.push_back(command);
    record.channels.push_back(torque);
  }
  const Record modelled = simulate(model_with("9490"), record);
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const char* name : {"piston.pitch", "engine.pitch", "piston.yaw", "engine.yaw"}) {
    record.channels.push_back(*modelled.find(name));
    for (double& value : record.channels.back().values) {
      value += (name[0] == 'p' ? kPistonNoise : kEngineNoise) * normal(random);
    }
  }
  return record;
}

/// The error of each channel that the calibrated model leaves, over its noise: the larger one.
double error_left(const VehicleFile& model, const Record& record) {
  explain::ExplainOptions options;
  options.threads = 2;
  options.most_effects = 0;
  const auto explained = explain::explain(model, {record}, options);
  double worst = 0.0;
  for (const explain::ChannelErrors& channel : explained.result.channels) {
    worst = std::max(worst, channel.explained.rms / (channel.name[0] == 'p' ? kPistonNoise : kEngineNoise));
  }
  return worst;
}

void without(Record& record, const std::string& ending) {
  std::erase_if(record.channels, [&](const Channel& channel) { return channel.name.ends_with(ending); });
}

}  // namespace

TEST_GROUP(TwoAxes){};

TEST(TwoAxes, a_measured_torque_acts_on_both_axes_so_that_the_calibrated_model_leaves_the_noise_alone) {
  Record record = record_under({2e4, 3e4});
  const VehicleFile declared = model_with("9800");
  DOUBLES_EQUAL(1.0, error_left(declared, record), 0.05);
  without(record, "torque.yaw");
  CHECK(error_left(declared, record) > 2.0);
}

TEST(TwoAxes, the_measured_torque_of_an_axis_that_is_not_explained_acts_too) {
  Record record = record_under({0.0, 3e4});
  without(record, "engine.yaw");
  without(record, "piston.yaw");
  const VehicleFile declared = model_with("9490");
  DOUBLES_EQUAL(1.0, error_left(declared, record), 0.05);
  without(record, "torque.yaw");
  CHECK(error_left(declared, record) > 2.0);
}

TEST(TwoAxes, a_torque_that_is_missing_in_a_row_that_is_not_excluded_is_refused_with_its_time) {
  Record record = record_under({2e4, 0.0});
  record.channels[1].values[1000] = std::nan("");
  try {
    explain::axes_of(model_with("9490"), {record}, {});
    FAIL("a torque of NaN was taken");
  } catch (const UsageError& error) {
    STRCMP_CONTAINS("channel torque has no value at 2 s", error.what());
  }
}

TEST(TwoAxes, what_follows_the_thrust_is_refused_and_a_measured_thrust_that_does_nothing_is_named) {
  try {
    explain::axes_of(model_with("9490", "[gimbal]\nthrust = 1.86e6\npitch_misalignment = 3e-3\n"), {}, {});
    FAIL("a misaligned thrust was taken");
  } catch (const FileError& error) {
    STRCMP_CONTAINS("pitch_misalignment", error.what());
  }
  Record record = record_under({0.0, 0.0});
  record.channels.push_back({"thrust", "N", std::vector<double>(record.rows, 1e6)});
  const auto axes = explain::axes_of(model_with("9490"), {record}, {});
  STRCMP_EQUAL("thrust", axes[0].data.experiments[0].unused.at(0).c_str());
}
