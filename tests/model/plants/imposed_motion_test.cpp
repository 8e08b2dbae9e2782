// SPDX-License-Identifier: Apache-2.0
#include "model/imposed_motion.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Body = model::ImposedMotion<double>;

constexpr double kPathAmplitude = 0.02;
constexpr double kPathFrequency = 2.0 * std::numbers::pi * 3.0;  // rad/s

double path_at(double t) { return kPathAmplitude * std::sin(kPathFrequency * t); }

Body::Parameters damper() {
  Body::Parameters parameters;
  parameters.body = {4.0, 300.0, 2e4};
  return parameters;
}

/// Largest difference between the readings of two cycles of the path and `force(t)`, after a first cycle.
template <class Force>
double largest_error(const Body::Parameters& parameters, double h, Force&& force) {
  const Body body(parameters, h);
  Body::State state = body.at_rest(path_at(0.0));
  double largest = 0.0;
  for (int k = 1; k * h < 1.0; ++k) {
    body.step(state, path_at(k * h));
    // The reading is that of the start of the step.
    const double t = (k - 1) * h;
    if (t > 1.0 / 3.0) {
      largest = std::max(largest, std::abs(Body::measured(state)[0] - force(t)));
    }
  }
  return largest;
}

}  // namespace

TEST_GROUP(ImposedMotion){};

// A sin(w t): the force is (k - m w^2) A sin + c w A cos. The second difference is off by (w h)^2 / 12 of the inertia's
// part, the mean of two chords by (w h)^2 / 6 of the damping's and (w h)^2 / 4 of the spring's: second order.
TEST(ImposedMotion, TakesTheForceOfInertiaDampingAndSpringToSecondOrderInTheStep) {
  const auto force = [](double t) {
    return (2e4 - 4.0 * kPathFrequency * kPathFrequency) * path_at(t) +
           300.0 * kPathFrequency * kPathAmplitude * std::cos(kPathFrequency * t);
  };
  const double coarse = largest_error(damper(), 2e-3, force);
  const double fine = largest_error(damper(), 1e-3, force);
  const double wh = kPathFrequency * 1e-3;
  CHECK_TRUE(fine < wh * wh * kPathAmplitude *
                        (4.0 * kPathFrequency * kPathFrequency / 12.0 + 300.0 * kPathFrequency / 6.0 + 2e4 / 4.0));
  DOUBLES_EQUAL(4.0, coarse / fine, 0.1);
}

// While the play of half width w is taken up after a turn at A, over 2 w, the damper does not move; beyond it the force is
// that of the declared damper. Two readings see a step in which the play ends.
TEST(ImposedMotion, DamperWithFreePlayRestsOverThePlayAfterEveryTurn) {
  constexpr double half_width = 0.004;
  Body::Parameters parameters = damper();
  parameters.body.inertia = 0.0;
  parameters.body.stiffness = 0.0;
  ParamsOf<model::FreePlay, double> play;
  play.option = option_named<model::FreePlay>("damper");
  play.half_width = half_width;
  activate<model::FreePlay, Body>(parameters, play);
  constexpr double h = 1e-4;
  const Body body(parameters, h);
  Body::State state = body.at_rest(0.0);
  double turned_at = 0.0;
  int resting = 0;
  int moving = 0;
  for (int k = 1; k * h < 1.0; ++k) {
    const double before = path_at((k - 1) * h);
    const double velocity = kPathAmplitude * kPathFrequency * std::cos(kPathFrequency * (k - 1) * h);
    const double next = path_at(k * h);
    turned_at = velocity * (path_at((k - 2) * h) - before) > 0.0 ? before : turned_at;
    body.step(state, next);
    const double since = std::abs(before - (velocity > 0.0 ? -kPathAmplitude : kPathAmplitude));
    const double force = Body::measured(state)[0];
    const double margin = 3.0 * h * kPathAmplitude * kPathFrequency;
    if (k * h < 0.5) {
      continue;
    }
    if (since > margin && since < 2.0 * half_width - margin) {
      DOUBLES_EQUAL(0.0, force, 1e-9);
      ++resting;
    } else if (since > 2.0 * half_width + margin) {
      DOUBLES_EQUAL(300.0 * velocity, force, 1e-3 * 300.0 * kPathAmplitude * kPathFrequency);
      ++moving;
    }
  }
  CHECK_TRUE(resting > 500);
  CHECK_TRUE(moving > 500);
}

// Between the clearances the declared spring alone acts, and beyond them the stop as well; the play of a spring takes its
// whole force away. At rest every law is exact.
TEST(ImposedMotion, StopAndFreePlayOfASpringActWhereTheirWidthsSay) {
  Body::Parameters parameters = damper();
  ParamsOf<model::ElasticStop, double> stop;
  stop.stiffness = 1e5;
  stop.forward = 0.01;
  stop.backward = 0.02;
  activate<model::ElasticStop, Body>(parameters, stop);
  ParamsOf<model::FreePlay, double> play;
  play.option = option_named<model::FreePlay>("spring");
  play.half_width = 0.005;
  activate<model::FreePlay, Body>(parameters, play);
  const Body body(parameters, 1e-3);
  const auto force_at = [&](double position) {
    Body::State state = body.at_rest(position);
    body.step(state, position);
    body.step(state, position);
    return Body::measured(state)[0];
  };
  DOUBLES_EQUAL(0.0, force_at(0.004), 1e-12);
  DOUBLES_EQUAL(0.0, force_at(-0.004), 1e-12);
  DOUBLES_EQUAL(2e4 * 0.004, force_at(0.009), 1e-9);
  DOUBLES_EQUAL(2e4 * 0.025 + 1e5 * 0.02, force_at(0.03), 1e-9);
  DOUBLES_EQUAL(-2e4 * 0.025 - 1e5 * 0.01, force_at(-0.03), 1e-9);
}

// Of c v^2 and the velocity that is left, c v^2 = (free velocity - v) / compliance: the force solves both.
TEST(ImposedMotion, QuadraticDampingSolvesItsForceTogetherWithTheVelocityItLeaves) {
  ParamsOf<model::QuadraticDamping, double> params;
  params.forward = 5.0;
  params.backward = 2.0;
  model::QuadraticDamping::State<double> state;
  for (const double free_velocity : {-3.0, -1e-3, 0.0, 1e-3, 3.0}) {
    for (const double compliance : {0.0, 1e-3, 10.0}) {
      const double force = model::QuadraticDamping::step(
          params, state, model::Motion<double>{0.0, free_velocity, free_velocity, compliance, 1e-3});
      const double velocity = free_velocity - compliance * force;
      DOUBLES_EQUAL((velocity > 0.0 ? 5.0 : -2.0) * velocity * velocity, force, 1e-12 * (1.0 + std::abs(force)));
      CHECK_TRUE(velocity * free_velocity >= 0.0);
    }
  }
}

}  // namespace hotfire::test
