// SPDX-License-Identifier: Apache-2.0
#include "model/direct.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Plant = model::Direct<double>;

/// Times [s] at which the mass passes zero upward, interpolated within a step, when a hammer blow sets it moving.
std::vector<double> hammer_test(const Plant& plant, double duration) {
  Plant::State state = plant.moving(0.0, 0.01);
  std::vector<double> passes;
  const double h = plant.step_size();
  for (int k = 0; k * h < duration; ++k) {
    const double before = state.y(0);
    plant.step(state, 0.0);
    if (before < 0.0 && state.y(0) >= 0.0) {
      passes.push_back((k + before / (before - state.y(0))) * h);
    }
  }
  return passes;
}

}  // namespace

TEST_GROUP(Direct){};

// [SD] eq. 8-10: with the actuator locked the engine swings on its load spring at sqrt((K_n + K_T R^2) / J), damped by D.
// The position between two steps of 0.5 ms is linear to (w h)^2 / 8 = 7e-5 of the swing; over 10 periods less than 1e-5.
TEST(Direct, SwingsAtTheFrequencyOfTheLockedPendulum) {
  constexpr double load_spring = 1.0 / (1.0 / 1.2e8 + 1.0 / 5.75e7);
  constexpr double stiffness = 4e5 + load_spring * 0.7544 * 0.7544;
  constexpr double inertia = 9490.0;
  constexpr double damping = 1.2e4;
  const double natural = std::sqrt(stiffness / inertia);
  const double ratio = damping / (2.0 * inertia * natural);

  Plant::Parameters parameters;
  parameters.mass = {inertia, damping, stiffness};
  const std::vector<double> passes = hammer_test(Plant(parameters, 5e-4), 2.0);
  CHECK_TRUE(passes.size() > 10);
  const double measured = 2.0 * std::numbers::pi * 10.0 / (passes[10] - passes[0]);
  DOUBLES_EQUAL(natural * std::sqrt(1.0 - ratio * ratio), measured, 1e-5 * natural);
  DOUBLES_EQUAL(7.75, natural / (2.0 * std::numbers::pi), 0.25);  // [SD 2.2]: 7.5-8 Hz with linear stiffness
}

// m x'' + c x' + k x = F with F held: the exact hold leaves rounding only, at any step.
TEST(Direct, FollowsTheClosedSolutionAtAnyStep) {
  Plant::Parameters parameters;
  parameters.mass = {2.0, 0.6, 50.0};
  constexpr double force = 3.0;
  const double decay = 0.6 / 4.0;
  const double damped = std::sqrt(25.0 - decay * decay);
  const double rest = force / 50.0;
  for (const double h : {1e-4, 1e-2, 0.5}) {
    const Plant plant(parameters, h);
    Plant::State state = plant.at_rest(0.0);
    double time = 0.0;
    for (int k = 1; k * h < 10.0; ++k) {
      plant.step(state, force);
      time = k * h;
    }
    const double exact =
        rest * (1.0 - std::exp(-decay * time) * (std::cos(damped * time) + decay / damped * std::sin(damped * time)));
    DOUBLES_EQUAL(exact, state.y(0), 1e-10 * rest);  // 100,000 steps of 1e-16, and the same again in the exponential
  }
}

// m x'' = F - c x' - k x at the end of a step, and at the start of a motion to first order.
TEST(Direct, ReadsVelocityAndAccelerationOfTheEndOfAStepToSecondOrder) {
  Plant::Parameters parameters;
  parameters.mass = {2.0, 0.6, 50.0};
  const auto force_at = [](double t) { return 3.0 * std::sin(7.0 * t); };
  const auto error_with = [&](double h) {
    const Plant plant(parameters, h);
    Plant::State state = plant.moving(0.1, -0.2, force_at(0.0));
    double largest = 0.0;
    for (int k = 1; k * h < 2.0; ++k) {
      plant.step(state, force_at((k - 0.5) * h));
      const auto& read = Plant::measured(state);
      DOUBLES_EQUAL(state.y(0), read[Plant::kPosition], 0.0);
      DOUBLES_EQUAL(state.y(1), read[Plant::kVelocity], 0.0);
      const double exact = (force_at(k * h) - 0.6 * read[Plant::kVelocity] - 50.0 * read[Plant::kPosition]) / 2.0;
      largest = k > 1 ? std::max(largest, std::abs(read[Plant::kAcceleration] - exact)) : largest;
    }
    return largest;
  };
  const double fine = error_with(1e-3);
  CHECK(fine < 1e-4);
  DOUBLES_EQUAL(4.0, error_with(2e-3) / fine, 0.2);
  // F - c v - k x is -4.88 N.
  DOUBLES_EQUAL(-2.44, Plant::measured(Plant(parameters, 1e-6).moving(0.1, -0.2, 0.0))[Plant::kAcceleration], 1e-4);
}

TEST(Direct, KeepsItsEnergyWithoutDamping) {
  Plant::Parameters parameters;
  parameters.mass = {2.0, 0.0, 50.0};
  const Plant plant(parameters, 1e-3);
  Plant::State state = plant.moving(0.3, -1.0);
  const auto energy = [&] { return 0.5 * (2.0 * state.y(1) * state.y(1) + 50.0 * state.y(0) * state.y(0)); };
  const double first = energy();
  for (int k = 0; k < 100'000; ++k) {
    plant.step(state, 0.0);
  }
  DOUBLES_EQUAL(first, energy(), 1e-10 * first);
}

// Friction that holds the mass balances the force at each instant: at the start, after a step and on a ramp.
TEST(Direct, ReadsNoAccelerationWhileFrictionHoldsIt) {
  Plant::Parameters parameters;
  parameters.mass = {1.0, 0.2, 0.0};
  ParamsOf<model::SlidingFriction, double> friction;
  friction.coulomb_forward = friction.coulomb_backward = 10.0;
  activate<model::SlidingFriction, Plant>(parameters, friction);
  const Plant plant(parameters, 5e-4);
  DOUBLES_EQUAL(0.0, Plant::measured(plant.moving(0.0, 0.0, 5.0))[Plant::kAcceleration], 1e-9);
  Plant::State state = plant.at_rest(0.0);
  for (int k = 0; k < 400; ++k) {
    plant.step(state, k < 100 ? 0.0 : k < 200 ? 5.0 : 5.0 * std::sin(0.03 * k));
    DOUBLES_EQUAL(0.0, Plant::measured(state)[Plant::kAcceleration], 1e-9);
  }
  // Just before it breaks away it reads nothing, just after that what the force has more than the friction.
  for (const double force : {9.99, 10.5}) {
    state = plant.at_rest(0.0);
    plant.step(state, force);
    plant.step(state, force);
    DOUBLES_EQUAL(std::max(0.0, force - 10.0), Plant::measured(state)[Plant::kAcceleration], 1e-3);
  }
}

// The difference of the velocities over two steps is the acceleration between them, to second order: also of a bristle.
TEST(Direct, ReadsTheAccelerationThatItsVelocityHasUnderEveryLawOfFriction) {
  constexpr double h = 2e-4;
  for (int law = 0; law < static_cast<int>(model::SlidingFriction::options.size()); ++law) {
    Plant::Parameters parameters;
    parameters.mass = {1.0, 0.5, 40.0};
    activate<model::SlidingFriction, Plant>(parameters, typical<model::SlidingFriction, double>(law));
    const Plant plant(parameters, h);
    Plant::State state = plant.at_rest(0.0);
    std::vector<double> velocity;
    std::vector<double> acceleration;
    for (int k = 0; k < 5000; ++k) {
      plant.step(state, 40.0 * std::sin(4.0 * h * k));
      velocity.push_back(state.y(1));
      acceleration.push_back(Plant::measured(state)[Plant::kAcceleration]);
    }
    double error = 0.0;
    double size = 0.0;
    for (std::size_t k = 2; k + 1 < velocity.size(); ++k) {
      const double mean = (velocity[k + 1] - velocity[k - 1]) / (2.0 * h);
      error += (acceleration[k] - mean) * (acceleration[k] - mean);
      size += mean * mean;
    }
    CHECK_TRUE(std::sqrt(error / size) < 2e-3);
  }
}

// A body that slides on rigid Coulomb friction with 2 m/s^2 stops after v^2 / (2 a), and stays.
TEST(Direct, StopsUnderCoulombFrictionAndStays) {
  Plant::Parameters parameters;
  ParamsOf<model::SlidingFriction, double> friction;
  friction.option = 0;
  friction.coulomb_forward = 2.0;
  friction.coulomb_backward = 2.0;
  activate<model::SlidingFriction, Plant>(parameters, friction);
  const Plant plant(parameters, 1e-3);
  Plant::State state = plant.moving(0.0, 1.0);
  for (int k = 0; k < 600; ++k) {
    plant.step(state, 0.0);
  }
  const double stopped = state.y(0);
  DOUBLES_EQUAL(0.25, stopped, 1e-3);  // a step of 1 ms at the last speed
  for (int k = 0; k < 1000; ++k) {
    plant.step(state, k < 500 ? 1.9 : -1.9);
  }
  DOUBLES_EQUAL(stopped, state.y(0), 1e-12);
}

// Different levels per direction: 5 N forward and 3 N backward let a force of 4 N move it backward only.
TEST(Direct, HasItsOwnFrictionInEachDirection) {
  for (int law = 0; law < 3; ++law) {
    Plant::Parameters parameters;
    auto friction = typical<model::SlidingFriction, double>(law);
    friction.coulomb_forward = 5.0;
    friction.coulomb_backward = 3.0;
    friction.static_ratio = 1.0;
    friction.stiffness = 1e5;
    activate<model::SlidingFriction, Plant>(parameters, friction);
    const Plant plant(parameters, 1e-3);
    Plant::State forward = plant.at_rest(0.0);
    Plant::State backward = plant.at_rest(0.0);
    for (int k = 0; k < 1000; ++k) {
      plant.step(forward, 4.0);
      plant.step(backward, -4.0);
    }
    CHECK_TRUE(std::abs(forward.y(0)) < 1e-3);  // no more than the bristle yields: 4 N / 1e5 N/m, with its first swing twice
    CHECK_TRUE(backward.y(0) < -0.3);           // half of 1 m/s^2 for 1 s, less the viscous part
  }
}

// A free mass under a constant input F gains F / m a second. The drive has the delay, then its dead band; its saturation
// comes first.
TEST(Direct, DriveLimitsDelaysAndSwallowsItsInputInThisOrder) {
  Plant::Parameters parameters;
  parameters.mass = {2.0, 0.0, 0.0};
  ParamsOf<model::DriveSaturation, double> saturation;
  saturation.limit = 10.0;
  activate<model::DriveSaturation, Plant>(parameters, saturation);
  ParamsOf<model::CommandDelay, double> delay;
  delay.delay = 0.02;
  activate<model::CommandDelay, Plant>(parameters, delay);
  ParamsOf<model::DriveDeadband, double> deadband;
  deadband.half_width = 4.0;
  activate<model::DriveDeadband, Plant>(parameters, deadband);
  const Plant plant(parameters, 1e-3);
  Plant::State state = plant.at_rest(0.0);
  for (int k = 0; k < 120; ++k) {
    plant.step(state, 25.0);
  }
  DOUBLES_EQUAL((10.0 - 4.0) / 2.0 * 0.1, state.y(1), 1e-12);
  for (int k = 0; k < 20; ++k) {
    plant.step(state, 3.0);
  }
  const double before = state.y(1);
  for (int k = 0; k < 50; ++k) {
    plant.step(state, 3.0);
  }
  DOUBLES_EQUAL(before, state.y(1), 1e-12);
}

}  // namespace hotfire::test
