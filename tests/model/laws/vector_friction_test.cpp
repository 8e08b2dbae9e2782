// SPDX-License-Identifier: Apache-2.0
#include "model/friction/vector_friction.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <string>

#include "model/engine/gimbal.hpp"
#include "tests/model/support/every_effect.hpp"

namespace hotfire::test {
namespace {

using Friction = model::BearingFriction<double>;
using Pair = model::Pair<double>;
using Slip = model::Slip<double>;

constexpr double kVectorFrictionStep = 1e-4;

/// A slip that nothing can change: the torque is the law's own.
Slip imposed(const Pair& velocity) { return {velocity, velocity, {}, kVectorFrictionStep}; }

/// A slip that the torque slows, unequally in the two directions.
Slip resisted(const Pair& free_velocity) { return {free_velocity, free_velocity, {3e-8, 2e-8, 5e-9}, kVectorFrictionStep}; }

Friction law(int option) { return {option, 8e3, 1e8, 1.2, 0.01, 1e3, 0.5, 0.02}; }
Friction law(Friction::Law own) { return law(static_cast<int>(own)); }

/// Mean friction over its level under a slip `velocity(t)`, along pitch, over `periods` periods of `duration` after one
/// more.
template <class Velocity>
double mean_friction(const Friction& friction, double duration, int periods, Velocity&& velocity) {
  Pair deflection;
  double sum = 0.0;
  const int steps = static_cast<int>(std::lround(duration / kVectorFrictionStep));
  for (int k = -steps; k < steps * periods; ++k) {
    const Pair torque = friction.torque(deflection, imposed(velocity((k + 0.5) * kVectorFrictionStep)));
    sum += k < 0 ? 0.0 : torque.pitch;
  }
  return sum / (steps * periods * friction.coulomb_torque);
}

}  // namespace

TEST_GROUP(VectorFriction){};

// F10: slip in yaw lowers the friction in pitch as v_pitch / |v|, once the bristle has reached its steady deflection.
TEST(VectorFriction, SharesItsLevelBetweenTheDirectionsOfTheSlip) {
  for (int option = 0; option < 4; ++option) {
    Friction friction = law(option);
    for (const double yaw : {0.0, 0.05, 0.2, 1.0}) {
      const Pair velocity{0.1, yaw};
      Pair deflection;
      Pair torque;
      for (int k = 0; k < 2000; ++k) {
        torque = friction.torque(deflection, imposed(velocity));
      }
      Pair along;
      Pair alone;
      for (int k = 0; k < 2000; ++k) {
        alone = friction.torque(along, imposed({velocity.length(), 0.0}));
      }
      DOUBLES_EQUAL(0.1 / velocity.length() * alone.pitch, torque.pitch, 1e-9 * alone.pitch);
      DOUBLES_EQUAL(yaw / velocity.length() * alone.pitch, torque.yaw, 1e-9 * alone.pitch);
    }
  }
}

// One direction at a time, the vector law is the scalar one. The bearing's law finds speed and torque together, so the
// scalar law is given the speed that solves it.
TEST(VectorFriction, IsTheScalarLawAlongOneDirection) {
  const model::Bristle<double> bristle{1e8, 1e3, 0.0};
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double velocity = random.either_sign(1e-6, 1.0);
    const double free_velocity = velocity * random.uniform(0.5, 2.0);
    const double start = random.uniform(-8e-5, 8e-5);
    const model::Motion<double> motion{0.0, velocity, free_velocity, 3e-8, kVectorFrictionStep};
    double scalar_deflection = start;
    const double scalar = model::bristle_force<double>(scalar_deflection, motion, 8e3, bristle);
    for (const bool yaw : {false, true}) {
      const auto along = [&](double x) { return yaw ? Pair{0.0, x} : Pair{x, 0.0}; };
      const auto check = [&](const Pair& expected, const Pair& value, double tolerance) {
        DOUBLES_EQUAL(0.0, (expected - value).length(), tolerance);
      };
      const Slip slip{along(velocity), along(free_velocity), {3e-8, 3e-8, 0.0}, kVectorFrictionStep};
      Pair deflection = along(start);
      check(along(scalar), model::bristle_torque<double>(deflection, slip, std::abs(velocity), 8e3, bristle), 1e-9);
      check(along(scalar_deflection), deflection, 1e-17);
      check(along(model::coulomb_force<double>(motion, 8e3)), model::coulomb_torque<double>(slip, 8e3), 1e-8);
    }
  }
}

// Rigid friction holds while it can, and slides along the velocity that is left when it cannot.
TEST(VectorFriction, OpposesTheSlipThatItLeavesAndNeverReversesIt) {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Slip slip = resisted({random.either_sign(1e-6, 1.0), random.either_sign(1e-6, 1.0)});
    const Pair torque = model::coulomb_torque<double>(slip, 8e3);
    const Pair left = slip.free_velocity - slip.compliance.times(torque);
    CHECK_TRUE(torque.length() <= 8e3 * (1.0 + 1e-6));
    const double held = left.length() / (slip.free_velocity.length() + 1e-30);
    if (torque.length() < 8e3 * (1.0 - 1e-6)) {
      CHECK_TRUE(held < 1e-12);
    } else {
      const double along = torque.pitch * left.pitch + torque.yaw * left.yaw;
      DOUBLES_EQUAL(torque.length() * left.length(), along, 1e-9 * torque.length() * slip.free_velocity.length());
    }
  }
}

TEST(VectorFriction, SolvesSpeedAndTorqueTogether) {
  Random random(7);
  for (int option = 1; option < 4; ++option) {
    const Friction friction = law(option);
    for (int i = 0; i < 200; ++i) {
      Pair deflection{random.uniform(-4e-5, 4e-5), random.uniform(-4e-5, 4e-5)};
      // Half a radian a second and megajoules of compliance: what a bearing of 1.7e7 N.m/rad adds within a step.
      Slip slip{{}, {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)}, {4e-5, 4e-5, 0.0}, 5e-4};
      slip.velocity = slip.free_velocity;
      Pair again = deflection;
      const Pair torque = friction.torque(deflection, slip);
      slip.velocity = slip.free_velocity - slip.compliance.times(torque);
      const Pair repeated = friction.torque(again, slip);
      CHECK_TRUE((torque - repeated).length() < 0.02 * friction.coulomb_torque);
    }
  }
}

TEST(VectorFriction, TakesNoEnergyOutOfARoundTrip) {
  for (int option = 0; option < 4; ++option) {
    const Friction friction = law(option);
    for (const double speed : {1e-4, 1e-2, 0.3}) {
      Pair deflection;
      double work = 0.0;
      for (int k = 0; k < 40'000; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 10'000;
        const Slip slip = imposed({speed * std::cos(angle), speed * std::sin(2.0 * angle)});
        const Pair torque = friction.torque(deflection, slip);
        work +=
            k < 10'000 ? 0.0 : kVectorFrictionStep * (torque.pitch * slip.velocity.pitch + torque.yaw * slip.velocity.yaw);
      }
      CHECK_TRUE(work >= 0.0);
    }
  }
}

// F11, closed forms of physics.md section 3 for rigid friction: a sine along the motion gives (2/pi) asin(v/V).
TEST(VectorFriction, LosesToASineAlongTheMotionWhatTheClosedFormSays) {
  const Friction rigid = law(Friction::Law::coulomb);
  for (const double ratio : {0.1, 0.3, 0.5, 0.8, 0.95}) {
    const double mean = mean_friction(rigid, 0.1, 1, [&](double t) {
      return Pair{0.1 * ratio + 0.1 * std::sin(2.0 * std::numbers::pi * 10.0 * t), 0.0};
    });
    const double closed = 2.0 / std::numbers::pi * std::asin(ratio);
    DOUBLES_EQUAL(closed, mean, 0.03 * closed);
  }
}

// Gaussian vibration, a new draw each step: erf along the motion; in two dimensions sqrt(pi/8) (v/s) e^-q (I0(q) + I1(q)),
// q = v^2 / (4 s^2). The standard error of a mean over a million draws is below 0.1 % of the level.
TEST(VectorFriction, LosesToGaussianVibrationWhatTheClosedFormsSay) {
  const Friction rigid = law(Friction::Law::coulomb);
  Random random(13);
  const auto gaussian = [&] {
    return std::sqrt(-2.0 * std::log(random.uniform(1e-300, 1.0))) *
           std::cos(2.0 * std::numbers::pi * random.uniform(0.0, 1.0));
  };
  constexpr double sigma = 0.1;
  for (const double ratio : {0.2, 0.5, 1.0, 2.0}) {
    const double v = ratio * sigma;
    const double along = mean_friction(rigid, 10.0, 10, [&](double) { return Pair{v + sigma * gaussian(), 0.0}; });
    DOUBLES_EQUAL(std::erf(ratio / std::numbers::sqrt2), along, 0.03 * std::erf(ratio / std::numbers::sqrt2));
    const double both = mean_friction(rigid, 10.0, 10, [&](double) {
      return Pair{v + sigma * gaussian(), sigma * gaussian()};
    });
    const double q = 0.25 * ratio * ratio;
    const double closed =
        std::sqrt(std::numbers::pi / 8.0) * ratio * std::exp(-q) * (std::cyl_bessel_i(0.0, q) + std::cyl_bessel_i(1.0, q));
    DOUBLES_EQUAL(closed, both, 0.03 * closed);
  }
}

// A bristle that vibration of velocity V at frequency f deflects by V / (2 pi f): with that far beyond the bristle's own
// deflection it is rigid friction; the same velocity at a hundred times the frequency stays within it, and the bristle's
// path gives v / mean |v + w|.
TEST(VectorFriction, LosesToFastVibrationWithinTheBristleWhatItsPathSays) {
  Friction bristle = law(Friction::Law::dahl);
  bristle.stiffness = 8e3 / 0.1;  // yields at 0.1 rad; the vibration moves by 1.6e-3
  const double ratio = 0.5;
  const double mean = mean_friction(bristle, 10.0, 1, [&](double t) {
    return Pair{0.1 * ratio + 0.1 * std::sin(2.0 * std::numbers::pi * 10.0 * t), 0.0};
  });
  const double path = 2.0 / std::numbers::pi * (ratio * std::asin(ratio) + std::sqrt(1.0 - ratio * ratio));
  DOUBLES_EQUAL(ratio / path, mean, 0.03 * ratio / path);
}

TEST(VectorFriction, IsLoweredAtLowSpeedByTheVibrationLaw) {
  Friction vibrated = law(Friction::Law::vibrated_lugre);
  vibrated.static_ratio = 1.0;
  for (const double speed : {1e-4, 0.02, 0.2}) {
    const double mean = mean_friction(vibrated, 5.0, 1, [&](double) { return Pair{speed, 0.0}; });
    DOUBLES_EQUAL(1.0 - 0.5 * std::exp(-speed / 0.02), mean, 0.005);
  }
}

TEST(VectorFriction, IsEitherSimulatedUnderVibrationOrLoweredByItsLaw) {
  model::GimbalParameters<double> gimbal;
  gimbal.friction = law(Friction::Law::lugre);
  gimbal.vibration = {0.01, 0.0, 200.0};
  CHECK_TRUE(model::broken_relation(gimbal).empty());
  gimbal.friction.choose(Friction::Law::vibrated_lugre);
  CHECK_TRUE(model::broken_relation(gimbal).find("two ways to the same physics") != std::string_view::npos);
  gimbal.vibration = {};
  CHECK_TRUE(model::broken_relation(gimbal).empty());
}

}  // namespace hotfire::test
