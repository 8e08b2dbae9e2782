// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/vehicle/vehicle_axes.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tests/explain/readings.hpp"
#include "tests/files/scratch.hpp"
#include "tests/support/attach_points.hpp"
#include "tools/explain/explain.hpp"
#include "tools/explain/terms/assessed.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/structure/synthetic.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;

constexpr double kPistonNoise = 8e-6;
constexpr double kEngineNoise = 6e-5;
constexpr const char* kMisaligned =
    "[gimbal]\nthrust = 5e5\nrated_thrust = 1.86e6\npitch_misalignment = 5e-3\nunloaded_structure = 0.5\n"
    "unloaded_stiffness = 0.5\nstiffness = [[5e8, 0, 0, 0, 0, 0], [0, 5e8, 0, 0, 0, 0], [0, 0, 5e8, 0, 0, 0], "
    "[0, 0, 0, 1e8, 0, 0], [0, 0, 0, 0, 1e8, 0], [0, 0, 0, 0, 0, 1e8]]\n";

constexpr const char* kFriction =
    "[gimbal.friction]\nlaw = \"lugre\"\ncoulomb_torque = 8e3\ncoefficient = 0.08\nradius = 0.13\nstiffness = 1e8\n"
    "static_ratio = 1.2\nstribeck_velocity = 0.02\ndamping = 3e3\n";

/// Two axes on inclined attach points, so that a torque about one of them moves the other.
VehicleFile model_with(const std::string& inertia, const std::string& more = "") {
  return parse_vehicle("schema = 1\ntopology = \"taos\"\n[engine]\ninertia = " + inertia +
                           "\n[sensors]\npiston_noise = 8e-6\nengine_noise = 6e-5\n[tolerance]\nengine.inertia = 0.05\n" +
                           test::kInclinedAttachPoints + more,
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
  test::add_readings(record, modelled,
                     {{"piston.pitch", kPistonNoise},
                      {"engine.pitch", kEngineNoise},
                      {"piston.yaw", kPistonNoise},
                      {"engine.yaw", kEngineNoise}},
                     random);
  return record;
}

/// Eight axes on a structure that has nearly all flexibility of the attach points in its modes.
VehicleFile flexible_vehicle() {
  const test::Scratch scratch;
  scratch.write("modes.csv", mode_table_text(synthetic_vehicle(3, 40), {}));
  return load_vehicle(scratch.write("masv.toml",
                                    "schema = 1\ntopology = \"masv\"\n[structure]\nstiffness = 4e8\n[modes]\n"
                                    "table = \"modes.csv\"\n[sensors]\npiston_noise = 8e-6\nengine_noise = 6e-5\n"));
}

/// 8 s of commands of every axis of a model, without sensor noise.
Record record_of(const VehicleFile& model) {
  Record record;
  record.name = record.path = "all.csv";
  record.period = 2e-3;
  record.rows = 4000;
  const std::vector<std::string> names = axis_names(static_cast<int>(model.axes.size() / 2));
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    Channel command{"command." + names[axis], "rad", {}};
    for (std::size_t row = 0; row < record.rows; ++row) {
      const double t = static_cast<double>(row) * record.period;
      const double frequency = 0.5 + 0.4 * static_cast<double>(axis) + 0.2 * t;
      command.values.push_back(t < 0.5 ? 0.0 : 8e-3 * std::sin(2.0 * std::numbers::pi * frequency * t));
    }
    record.channels.push_back(command);
  }
  const Record modelled = simulate(model, record);
  for (const std::string& name : names) {
    record.channels.push_back(*modelled.find("piston." + name));
    record.channels.push_back(*modelled.find("engine." + name));
  }
  return record;
}

/// What an axis as declared does beside the motion that is given, against what it did in the vehicle: the largest rms
/// difference of its channels over their noise.
double largest_difference(const explain::AxisOfVehicle& axis, const explain::CoupledRun& run, std::size_t place) {
  explain::Fitted declared;
  declared.base = std::get<SimplexParameters>(axis.model.parameters);
  declared.temper.assign(axis.data.channels.size(), 1.0);
  const auto alone = explain::assess(explain::Evaluator(axis.data, explain::Resolution::fine), 2, declared);
  double worst = 0.0;
  for (const std::size_t channel : {0, 1}) {
    const std::vector<double>& together = run.prediction[place][0][channel];
    double square = 0.0;
    for (std::size_t row = 0; row < together.size(); ++row) {
      square += std::pow(together[row] - alone.prediction[0][channel][row], 2);
    }
    worst = std::max(
        worst, std::sqrt(square / static_cast<double>(together.size())) / (channel == 0 ? kPistonNoise : kEngineNoise));
  }
  return worst;
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

/// With the measured torques the calibrated model leaves the noise alone; without that about yaw it leaves more.
void check_torque_about_yaw_acts(Record record, const VehicleFile& declared) {
  DOUBLES_EQUAL(1.0, error_left(declared, record), 0.05);
  without(record, "torque.yaw");
  CHECK(error_left(declared, record) > 2.0);
}

}  // namespace

TEST_GROUP(VehicleAxes){};

TEST(VehicleAxes, a_measured_torque_acts_on_both_axes_so_that_the_calibrated_model_leaves_the_noise_alone) {
  check_torque_about_yaw_acts(record_under({2e4, 3e4}), model_with("9800"));
}

TEST(VehicleAxes, the_measured_torque_of_an_axis_that_is_not_explained_acts_too) {
  Record record = record_under({0.0, 3e4});
  without(record, "engine.yaw");
  without(record, "piston.yaw");
  check_torque_about_yaw_acts(std::move(record), model_with("9490"));
}

TEST(VehicleAxes, a_torque_that_is_missing_in_a_row_that_is_not_excluded_is_refused_with_its_time) {
  Record record = record_under({2e4, 0.0});
  record.channels[1].values[1000] = std::nan("");
  const std::string message = test::refusal<UsageError>([&] { explain::axes_of(model_with("9490"), {record}, {}); });
  STRCMP_CONTAINS("channel torque.pitch has no value at 2 s", message.c_str());
}

TEST(VehicleAxes, a_measured_thrust_is_named_where_nothing_responds_to_it_and_acts_where_something_does) {
  Record record = record_under({0.0, 0.0});
  record.channels.push_back({"thrust", "N", std::vector<double>(record.rows, 1e6)});
  const auto without = explain::axes_of(model_with("9490"), {record}, {});
  STRCMP_EQUAL("thrust", without.axes[0].data.experiments[0].unused.at(0).c_str());
  LONGS_EQUAL(2, without.disturbances[0].channels.size());
  const auto with = explain::axes_of(model_with("9490", kMisaligned), {record}, {});
  LONGS_EQUAL(0, with.axes[0].data.experiments[0].unused.size());
  STRCMP_EQUAL("thrust", with.disturbances[0].channels.back().name.c_str());
}

TEST(VehicleAxes, beside_the_run_of_the_whole_vehicle_an_axis_does_what_it_does_in_the_vehicle) {
  struct Vehicle {
    VehicleFile model;
    double most;  ///< difference over the noise
  };
  // Rows of 2 ms are interpolated. On a compliant bearing friction breaks away within less than a row.
  const std::string rigid = std::string("[gimbal]\nthrust = 5e5\npitch_misalignment = 5e-3\n") + kFriction;
  const std::string compliant = std::string(kMisaligned) + kFriction;
  const std::string blocked = std::string(kMisaligned) + "block_mass = 50\nblock_inertia = 1\n" + kFriction;
  for (const Vehicle& tried : {Vehicle{model_with("9490", kMisaligned), 0.2}, Vehicle{model_with("9490", rigid), 0.2},
                               Vehicle{model_with("9490", compliant), 0.7}, Vehicle{model_with("9490", blocked), 0.7},
                               Vehicle{flexible_vehicle(), 0.2}}) {
    const Record record = record_of(tried.model);
    explain::VehicleAxes vehicle = explain::axes_of(tried.model, {record}, {});
    const auto run = explain::run_coupled(tried.model.parameters, vehicle, 2);
    CHECK_TRUE(run.has_value());
    explain::put_beside(*run, vehicle);
    for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
      CHECK_COMPARE(largest_difference(vehicle.axes[i], *run, i), <, tried.most);
      // Without what the vehicle does the difference is many times the noise.
      vehicle.axes[i].data.experiments[0].vehicle = {};
      CHECK_COMPARE(largest_difference(vehicle.axes[i], *run, i), >, 3.0);
    }
  }
}

TEST(VehicleAxes, strings_give_the_angles_of_an_engine_that_has_no_other_channel_and_are_named_beside_one) {
  const VehicleFile model = model_with("9490", "[strings]\nnoise = 0\n");
  const Record record = record_of(model);
  Record strings = record;
  for (const Channel& channel : simulate(model, record).channels) {
    if (channel.name.starts_with("string")) {
      strings.channels.push_back(channel);
    }
  }
  const auto beside = explain::axes_of(model, {strings}, {});
  LONGS_EQUAL(4, beside.axes[0].data.experiments[0].unused.size());
  without(strings, "engine.pitch");
  without(strings, "engine.yaw");
  const auto instead = explain::axes_of(model, {strings}, {});
  LONGS_EQUAL(0, instead.axes[0].data.experiments[0].unused.size());
  for (const std::size_t axis : {0, 1}) {
    const std::vector<double>& angle = record.find(axis == 0 ? "engine.pitch" : "engine.yaw")->values;
    for (std::size_t row = 0; row < angle.size(); row += 100) {
      DOUBLES_EQUAL(angle[row], instead.axes[axis].data.experiments[0].measured[1][row], 1e-9);
    }
  }
}
