// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tools/explain/explain.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/study/cases/case.hpp"
#include "tools/study/draws/random.hpp"

namespace hotfire::study {
namespace {

constexpr double kOpenPeriod = 2e-3;
constexpr std::size_t kOpenRows = 7500;

/// What an axis without position feedback does under commands of its valve, by the independent simulator. It starts with its
/// piston at `start` [m], which nothing pulls back: no ducts, no leakage.
Record open_loop_record(ReferenceAxis axis, double start, double noise_factor) {
  axis.position_feedback = 0.0;
  axis.duct_stiffness = 0.0;
  axis.leakage = 0.0;
  Random random("no feedback", 7);
  std::vector<double> command(kOpenRows, 0.0);
  for (int line = 0; line < 8; ++line) {
    const double turn = 2.0 * std::numbers::pi * random.log_uniform(0.3, 6.0);
    const double amplitude = 2e-4 * turn;
    for (std::size_t row = 0; row < kOpenRows; ++row) {
      command[row] += amplitude * std::sin(turn * kOpenPeriod * static_cast<double>(row));
    }
  }
  // The simulator reads a row at the end of its command.
  std::vector<double> later(command.begin(), command.end() - 1);
  later.insert(later.begin(), 0.0);
  const auto rows = integrate_reference(axis, later, kOpenPeriod, 1.0, 1e-8);
  Record record;
  record.path = record.name = "open.csv";
  record.period = kOpenPeriod;
  record.rows = kOpenRows;
  record.channels.push_back({"command", "rad", command});
  for (std::size_t c = 0; c < 2; ++c) {
    const double from = c == 0 ? start : start / axis.arm;
    Channel channel{kSensorGrades[c].channel, kSensorGrades[c].unit, {}};
    for (const auto& row : rows) {
      channel.values.push_back(from + row[c] + noise_factor * kSensorGrades[c].noise * random.normal());
    }
    record.channels.push_back(std::move(channel));
  }
  return record;
}

/// The axis as its engineer declares it.
ModelFile declared_open_loop() {
  ModelFile model;
  SimplexParameters declared;
  declared.servovalve.position_feedback = 0.0;
  declared.servovalve.rated_flow *= 1.02;
  declared.engine.duct_stiffness = 0.0;
  declared.actuator.leakage = 0.0;
  model.parameters = declared;
  model.tolerance = {{"servovalve.rated_flow", 0.03}, {"engine.inertia", 0.02}, {"structure.stiffness", 0.05}};
  return model;
}

void check_named(const char* name, const ReferenceAxis& axis) {
  explain::ExplainOptions options;
  options.threads = 2;
  const auto found = explain::explain(declared_open_loop(), {open_loop_record(axis, 0.02, 1.0)}, options);
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL(name, found.result.effects.front().name.c_str());
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK_TRUE(found.result.channels.at(c).explained.rms < 1.2 * kSensorGrades[c].noise);
  }
}

}  // namespace

TEST_GROUP(NoFeedback){};
TEST_GROUP(NoFeedbackAtLength){};

// The declared plant of the true parameters follows the simulator from where the piston is at the first row; the rest is the
// held spool of a step and the first row's own noise, which stays in an integrator.
TEST(NoFeedback, AxisStartsWhereItsPistonIsAndFollowsTheIndependentSimulator) {
  ModelFile model = declared_open_loop();
  std::get<SimplexParameters>(model.parameters).servovalve.rated_flow = ReferenceAxis().rated_flow;
  const Record record = open_loop_record({}, 0.02, 0.0);
  const Record simulated = simulate(model, record);
  const std::vector<double>& expected = record.find("piston")->values;
  const std::vector<double>& piston = simulated.find("piston")->values;
  double largest = 0.0;
  double travel = 0.0;
  for (std::size_t row = 0; row < record.rows; ++row) {
    largest = std::max(largest, std::abs(piston[row] - expected[row]));
    travel = std::max(travel, std::abs(expected[row] - 0.02));
  }
  CHECK_TRUE(travel > 0.004);
  CHECK_TRUE(largest < 2e-3 * travel);
}

TEST(NoFeedback, DeadBandOfTheValveIsNamed) {
  ReferenceAxis axis;
  axis.deadband = 0.03;
  check_named("valve_deadband", axis);
}

TEST(NoFeedbackAtLength, BiasOfTheValveIsNamed) {
  ReferenceAxis axis;
  axis.unlisted.null_offset = 0.004;
  check_named("valve_bias", axis);
}

TEST(NoFeedbackAtLength, DelayOfTheCommandIsNamed) {
  ReferenceAxis axis;
  axis.delay = 0.012;
  check_named("command_delay", axis);
}

}  // namespace hotfire::study
