#include "model/string_potentiometer.hpp"

#include <cmath>
#include <random>

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

TEST(StringPotentiometers, CannotTellTheStructuresMotionFromTheEngines) {
  const auto anchors = Strings::representative();
  const Strings strings(anchors);
  auto moved_anchors = anchors;
  const Eigen::Vector3d moved(1e-3, -5e-4, 7e-4);
  for (auto& anchor : moved_anchors) {
    anchor.vehicle_x += moved.x();
    anchor.vehicle_y += moved.y();
    anchor.vehicle_z += moved.z();
  }
  const auto told = strings.lengths(0.0, 0.0, moved);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& before = anchors[k];
    const auto& after = moved_anchors[k];
    const double exact = (after.engine() - after.vehicle()).norm() - (before.engine() - before.vehicle()).norm();
    // First order: a millimetre squared over a length of more than a metre.
    DOUBLES_EQUAL(exact, told[k], 2e-6);
  }
}

TEST(StringPotentiometers, ReadWithALagThatIsExactForAHeldLength) {
  const Readout readout{0.01, 0.0, 0.0};
  double held = 0.0;
  double reading = 0.0;
  for (int k = 0; k < 10; ++k) {
    reading = readout.read(held, 1.0, 0.0, 1e-3);
  }
  DOUBLES_EQUAL(1.0 - std::exp(-1.0), reading, 1e-12);
}

TEST(StringPotentiometers, ReadInStepsAndWithTheNoiseTheyAreGiven) {
  double held = 0.0;
  const Readout coarse{0.0, 0.0, 1e-3};
  DOUBLES_EQUAL(0.002, coarse.read(held, 0.00234, 0.0, 1e-3), 1e-12);
  DOUBLES_EQUAL(-0.002, coarse.read(held, -0.00234, 0.0, 1e-3), 1e-12);
  const Readout noisy{0.0, 1e-5, 0.0};
  DOUBLES_EQUAL(0.5 + 3e-5, noisy.read(held, 0.5, 3.0, 1e-3), 1e-15);
  const Readout ideal;
  DOUBLES_EQUAL(0.123, ideal.read(held, 0.123, 5.0, 1e-3), 0.0);
}

}  // namespace hotfire::test
