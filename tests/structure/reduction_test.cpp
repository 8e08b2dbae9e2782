// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/reduction.hpp"

#include <CppUTest/TestHarness.h>

#include <complex>
#include <fstream>
#include <numbers>
#include <sstream>

#include "tools/structure/synthetic.hpp"

namespace hotfire::test {
namespace {

const std::string kShipped = HOTFIRE_SOURCE_DIR "/tools/structure/synthetic_vehicle.csv";

/// Response of a port to its own force [m/N].
std::complex<double> response(const ModeSet& modes, int port, double frequency) {
  std::complex<double> sum = modes.residual(port, port);
  const double w = 2.0 * std::numbers::pi * frequency;
  for (int k = 0; k < modes.modes(); ++k) {
    const double own = 2.0 * std::numbers::pi * modes.frequency(k);
    sum += modes.shape(port, k) * modes.shape(port, k) /
           std::complex<double>(own * own - w * w, 2.0 * modes.damping_ratio(k) * own * w);
  }
  return sum;
}

}  // namespace

TEST_GROUP(Reduction){};

TEST(Reduction, KeepsAtMostFortyOfAHundredAndTwentyModesWithinOnePercent) {
  const ModeSet full = load_modes(kShipped);
  LONGS_EQUAL(120, full.modes());
  const ReductionGoal goal;
  const Reduction reduction = reduce(full, goal);
  CHECK_TRUE(reduction.reaches(goal));
  CHECK_TRUE(reduction.modes.modes() <= 40);
  // What it says of itself, found again on a plain grid of 2 mHz, a fifth of
  // the narrowest half-power width.
  for (int port = 0; port < 8; ++port) {
    double difference = 0.0;
    double size = 0.0;
    for (double f = goal.lowest; f <= goal.highest; f += 0.002) {
      const std::complex<double> wanted = response(full, port, f);
      difference += std::norm(response(reduction.modes, port, f) - wanted);
      size += std::norm(wanted);
    }
    const double error = std::sqrt(difference / size);
    CHECK_TRUE(error < 0.01);
    DOUBLES_EQUAL(reduction.error[static_cast<std::size_t>(port)], error, 0.05 * error);
  }
}

TEST(Reduction, KeepsOfAStageInFlightItsRigidBodyAndTheModesThatStay) {
  ModeSet full = load_modes(kShipped);
  const Eigen::Index all = full.modes() + 2;
  // Modes of the rigid body before and after those that bend.
  full.flight.frequency = Eigen::VectorXd::Zero(all);
  full.flight.frequency.segment(1, full.modes()) = full.frequency;
  full.flight.damping_ratio = Eigen::VectorXd::Zero(all);
  full.flight.side = Eigen::MatrixXd::Constant(2 * full.engines, all, 1.0);
  full.flight.sensor = Eigen::RowVectorXd::LinSpaced(all, 0.0, static_cast<double>(all - 1)).replicate(2, 1);
  full.flight.shape = Eigen::MatrixXd::Zero(full.ports() + full.string_shape.rows(), all);
  const Reduction reduction = reduce(full, ReductionGoal{});
  const FlightModes& flight = reduction.modes.flight;
  LONGS_EQUAL(reduction.modes.modes() + 2, flight.frequency.size());
  DOUBLES_EQUAL(0.0, flight.sensor(0, 0), 0.0);
  DOUBLES_EQUAL(static_cast<double>(all - 1), flight.sensor(0, flight.sensor.cols() - 1), 0.0);
  for (Eigen::Index k = 0; k < reduction.modes.modes(); ++k) {
    DOUBLES_EQUAL(reduction.modes.frequency(k), flight.frequency(k + 1), 0.0);
    DOUBLES_EQUAL(reduction.kept[static_cast<std::size_t>(k)] + 1.0, flight.sensor(1, k + 1), 0.0);
  }
}

TEST(Reduction, LeavesTheStaticFlexibilityAsItWas) {
  const ModeSet full = load_modes(kShipped);
  const Eigen::MatrixXd wanted = static_flexibility(full);
  for (const int most : {0, 7, 40}) {
    ReductionGoal goal;
    goal.most = most;
    const Reduction reduction = reduce(full, goal);
    CHECK_TRUE((static_flexibility(reduction.modes) - wanted).cwiseAbs().maxCoeff() <= 1e-15 * wanted.cwiseAbs().maxCoeff());
    CHECK_TRUE(reduction.modes.residual == reduction.modes.residual.transpose());
  }
}

TEST(Reduction, KeepsNoMoreModesThanTheGoalNeedsAndSaysWhenItIsMissed) {
  const ModeSet full = load_modes(kShipped);
  ReductionGoal coarse;
  coarse.error = 0.2;
  const Reduction few = reduce(full, coarse);
  CHECK_TRUE(few.reaches(coarse));
  CHECK_TRUE(few.modes.modes() < reduce(full, {}).modes.modes());
  ReductionGoal starved;
  starved.most = 3;
  const Reduction missed = reduce(full, starved);
  LONGS_EQUAL(3, missed.modes.modes());
  CHECK_FALSE(missed.reaches(starved));
}

// What a cut mode moved of a string at rest stays, as a share of the force on
// each port.
TEST(Reduction, LeavesTheMotionOfTheStringsAtRestAsItWas) {
  const ModeSet full = load_modes(kShipped);
  const ModeSet reduced = reduce(full, {}).modes;
  const Eigen::MatrixXd wanted = static_string_motion(full);
  CHECK_TRUE(wanted.rows() == 16 && wanted.cwiseAbs().maxCoeff() > 1e-10);
  CHECK_TRUE((static_string_motion(reduced) - wanted).cwiseAbs().maxCoeff() < 1e-13 * wanted.cwiseAbs().maxCoeff());
  CHECK_TRUE(reduced.string_residual.cwiseAbs().maxCoeff() > 0.01 * wanted.cwiseAbs().maxCoeff());
}

TEST(Reduction, NeedsNoModeForAnAttachPointThatNoneMoves) {
  ModeSet full = synthetic_vehicle(3, 9);
  full.shape.row(2).setZero();
  const Reduction reduction = reduce(full, {});
  DOUBLES_EQUAL(0.0, reduction.error[2], 0.0);
  CHECK_TRUE(reduction.reaches({}));
  const Reduction none = reduce(reduce(full, {.lowest = 1.0, .highest = 20.0, .error = 0.01, .most = 0}).modes, {});
  LONGS_EQUAL(0, none.modes.modes());
  CHECK_TRUE(none.reaches({}));
}

TEST_GROUP(SyntheticVehicle){};

TEST(SyntheticVehicle, IsShippedAsItsGeneratorMakesIt) {
  std::ifstream file(kShipped);
  std::stringstream text;
  text << file.rdbuf();
  CHECK_TRUE(text.str().starts_with("# SYNTHETIC"));
  const ModeSet shipped = load_modes(kShipped);
  const ModeSet made = synthetic_vehicle(20230203, 120);
  CHECK_TRUE(shipped.shape == made.shape && shipped.frequency == made.frequency);
  CHECK_TRUE(shipped.string_shape == made.string_shape);
}

TEST(SyntheticVehicle, HasManyModesInBandAndNoneThatDominates) {
  const ModeSet modes = load_modes(kShipped);
  const Eigen::MatrixXd flexibility = static_flexibility(modes);
  for (int port = 0; port < 8; ++port) {
    DOUBLES_EQUAL(1.0 / 1.05e8, flexibility(port, port), 0.11 / 1.05e8);
    for (int k = 0; k < modes.modes(); ++k) {
      const double w = 2.0 * std::numbers::pi * modes.frequency(k);
      CHECK_TRUE(modes.shape(port, k) * modes.shape(port, k) / (w * w) < 0.1 * flexibility(port, port));
    }
  }
  CHECK_TRUE(modes.frequency.minCoeff() >= 1.0 && modes.frequency.maxCoeff() <= 40.0);
}

}  // namespace hotfire::test
