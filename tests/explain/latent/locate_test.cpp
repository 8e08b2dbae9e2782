// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/locate.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"

namespace {

using namespace hotfire;
using namespace hotfire::test;
using explain::Located;

Located located_in(const ModelFile& truth, std::size_t copies = 1) {
  const explain::Dataset data = data_of(truth, copies);
  return explain::locate(data, about_declared(), 2);
}

}  // namespace

TEST_GROUP(Locate){};

TEST(Locate, NothingIsLocatedWhereNothingIsMissing) { CHECK(located_in(declared()).places.empty()); }

TEST(Locate, AWrongDeclaredValueWithinItsToleranceIsNoPlace) {
  ModelFile truth = declared();
  std::get<SimplexParameters>(truth.parameters).engine.inertia *= 1.02;
  CHECK(located_in(truth).places.empty());
}

TEST(Locate, AHardeningDuctActsAtTheEngineAndNowhereElse) {
  const Located located = located_in(with_effect<model::DuctHardening>({3e9}));
  CHECK(located.is_single);
  CHECK(located.allows("engine_torque"));
  for (const char* site : {"load_spring", "piston", "flow", "command", "sensor.piston", "sensor.engine"}) {
    CHECK(!located.allows(site));
  }
}

TEST(Locate, ABowedSensorIsTheSensorsAndNotThePlants) {
  const Located located = located_in(with_effect<model::SensorNonlinearity>({20.0, 0.0}, 1));
  CHECK(located.is_single);
  CHECK(located.allows("sensor.engine"));
  CHECK(!located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

TEST(Locate, ADeadBandActsOnTheOilWhichWithoutItsPressureNoSignalSeparatesFromTheValveOrThePiston) {
  const Located located = located_in(with_effect<model::ValveDeadband>({0.01}));
  CHECK(located.is_single);
  CHECK(located.allows("valve"));
  CHECK(located.allows("flow"));
  CHECK(!located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}

// The prior of a slow signal would compare places by how well it fits a fast one, which the plant smooths at every place but
// the sensor's.
TEST(Locate, AFastSignalOfASensorIsTheSensors) {
  Record record = record_of(declared());
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * record.period;
    record.channels[1].values[row] += 10.0 * kPistonNoise * std::sin(0.7 * t) * std::sin(2.0 * std::numbers::pi * 37.0 * t);
  }
  const Located located = explain::locate(explain::make_dataset(declared(), {record}), about_declared(), 2);
  CHECK(located.is_single);
  CHECK(located.allows("sensor.piston"));
  CHECK(!located.allows("sensor.engine"));
  CHECK(!located.allows("engine_torque"));
  CHECK(located.places.front().prior.correlation_time < 1.0);
}

TEST(Locate, AnInvisibleMissingTermIsNoPlace) {
  // A thousandth of the torque that the test above locates: below what 20 s of the sensors show.
  CHECK(located_in(with_effect<model::DuctHardening>({3e6})).places.empty());
}

TEST(Locate, LongRecordsAreThinnedAndGiveTheSamePlace) {
  const Located located = located_in(with_effect<model::DuctHardening>({3e9}), 25);  // 250,000 rows
  CHECK(located.allows("engine_torque"));
  CHECK(!located.allows("load_spring"));
}
