// SPDX-License-Identifier: Apache-2.0
#include "model/sensors/string_potentiometer.hpp"

#include <cmath>
#include <string>

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

using Strings = model::StringPotentiometers<double>;
using Readout = model::PotentiometerReadout<double>;

}  // namespace

TEST_GROUP(StringPotentiometers){};

// Every string by hand: the point on the engine turned by yaw about z and then by pitch about y, less its anchor.
TEST(StringPotentiometers, MeasureTheDistanceOfTheirTwoEnds) {
  const auto anchors = Strings::representative();
  const Strings strings(anchors);
  const double pitch = 0.05;
  const double yaw = -0.03;
  const auto lengths = strings.lengths(pitch, yaw, {0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d own = anchors[k].engine();
    const double x = std::cos(yaw) * own.x() - std::sin(yaw) * own.y();
    const double y = std::sin(yaw) * own.x() + std::cos(yaw) * own.y();
    const Eigen::Vector3d turned(std::cos(pitch) * x + std::sin(pitch) * own.z(), y,
                                 std::cos(pitch) * own.z() - std::sin(pitch) * x);
    DOUBLES_EQUAL((turned - anchors[k].vehicle()).norm() - (own - anchors[k].vehicle()).norm(), lengths[k], 1e-12);
  }
}

TEST(StringPotentiometers, CannotSeparateTheStructuresMotionFromTheEngines) {
  const auto anchors = Strings::representative();
  const Strings strings(anchors);
  auto moved_anchors = anchors;
  const Eigen::Vector3d moved(1e-3, -5e-4, 7e-4);
  for (auto& anchor : moved_anchors) {
    anchor.vehicle_x += moved.x();
    anchor.vehicle_y += moved.y();
    anchor.vehicle_z += moved.z();
  }
  const auto measured = strings.lengths(0.0, 0.0, moved);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& before = anchors[k];
    const auto& after = moved_anchors[k];
    const double exact = (after.engine() - after.vehicle()).norm() - (before.engine() - before.vehicle()).norm();
    // First order: a millimetre squared over a length of more than a metre.
    DOUBLES_EQUAL(exact, measured[k], 2e-6);
  }
}

TEST(StringPotentiometers, ReadWithALagThatIsExactForALengthThatMovesEvenly) {
  constexpr double kLag = 0.01;
  constexpr double kSpeed = 0.3;
  const Readout readout{kLag, 0.0, 0.0};
  Readout::State state;
  Readout::settle(state, 0.0);
  for (int k = 1; k <= 20; ++k) {
    const double t = k * 1e-3;
    // The solution of lag r' + r = speed t from rest.
    const double exact = kSpeed * (t - kLag * -std::expm1(-t / kLag));
    DOUBLES_EQUAL(exact, readout.read(state, kSpeed * t, 0.0, 1e-3), 1e-15);
  }
}

TEST(StringPotentiometers, ReadInStepsAndWithTheNoiseTheyAreGiven) {
  Readout::State state;
  const Readout coarse{0.0, 0.0, 1e-3};
  DOUBLES_EQUAL(0.002, coarse.read(state, 0.00234, 0.0, 1e-3), 1e-12);
  DOUBLES_EQUAL(-0.002, coarse.read(state, -0.00234, 0.0, 1e-3), 1e-12);
  const Readout noisy{0.0, 1e-5, 0.0};
  DOUBLES_EQUAL(0.5 + 3e-5, noisy.read(state, 0.5, 3.0, 1e-3), 1e-15);
  const Readout ideal;
  DOUBLES_EQUAL(0.123, ideal.read(state, 0.123, 5.0, 1e-3), 0.0);
}

TEST(StringPotentiometers, MustSeparatePitchFromYaw) {
  CHECK_TRUE(Strings::broken_relation(Strings::representative()).empty());
  auto slack = Strings::representative();
  slack[2] = {0.5, 0.1, 0.2, 0.5, 0.1, 0.2};
  STRCMP_CONTAINS("coincide", std::string(Strings::broken_relation(slack)).c_str());
  auto alike = Strings::representative();
  alike[2] = alike[0];
  alike[3] = alike[1];
  STRCMP_CONTAINS("cannot distinguish", std::string(Strings::broken_relation(alike)).c_str());
}

}  // namespace hotfire::test
