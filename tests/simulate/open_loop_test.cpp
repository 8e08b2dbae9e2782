// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/open_loop.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Axis = model::Simplex<double>;

/// An axis that an offset torque pushes against a play in its valve of 0.02 of full command.
Axis axis_with_play() {
  Axis::Parameters parameters;
  activate<model::ValveHysteresis, Axis>(parameters, {0, 0.02});
  activate<model::TorqueOffset, Axis>(parameters, {0, -2e4});
  return {parameters, 5e-4};
}

/// Readings about `reading` with a noise of `noise` in turn above and below, 30 rows at rest and then rows far away, where
/// the command has changed.
Record record_of(const std::string& channel, const std::string& unit, double reading, double noise) {
  constexpr std::size_t kAtRest = 30;
  Record record;
  record.period = 2e-3;
  record.rows = 2 * kAtRest;
  record.channels = {{"command", "rad", {}}, {channel, unit, {}}};
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[0].values.push_back(row < kAtRest ? 0.01 : 0.02);
    record.channels[1].values.push_back(row < kAtRest ? reading + (row % 2 == 0 ? noise : -noise) : 1.0);
  }
  return record;
}

double start_of_piston(const Record& record) { return start_of(axis_with_play(), record).y(Axis::kPiston); }

}  // namespace

TEST_GROUP(OpenLoop){};

// The middle of a play of 0.46 mm; the noise of one row is a tenth of that.
TEST(OpenLoop, AnAxisWithAPlayStartsWhereTheFirstRowsOfPistonOrEngineAre) {
  const Axis axis = axis_with_play();
  const double low = axis.resting(0.01, -1.0).y(Axis::kPiston);
  const double high = axis.resting(0.01, 1.0).y(Axis::kPiston);
  DOUBLES_EQUAL(2.0 * 0.02 / axis.parameters().servovalve.position_gain, high - low, 0.01 * (high - low));
  const double middle = 0.5 * (low + high);
  const double noise = 0.1 * (high - low);
  DOUBLES_EQUAL(middle, start_of_piston(record_of("piston", "m", middle, noise)), 1e-3 * noise);
  const double angle = middle / axis.parameters().actuator.moment_arm;
  DOUBLES_EQUAL(middle, start_of_piston(record_of("engine", "rad", angle, angle * noise / middle)), 1e-3 * noise);
  DOUBLES_EQUAL(high, start_of_piston(record_of("piston", "m", high + 2.0 * noise, noise)), 1e-3 * noise);
}

TEST(OpenLoop, WithoutPistonAndEngineItStartsInTheSteadyStateUnderTheFirstCommand) {
  Record record = record_of("piston", "m", 0.0, 0.0);
  record.channels.pop_back();
  DOUBLES_EQUAL(axis_with_play().steady(0.01).y(Axis::kPiston), start_of_piston(record), 0.0);
}

}  // namespace hotfire::test
