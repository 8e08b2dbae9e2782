// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <vector>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Plant = model::Direct<double>;

// The figures come from RK4 at 1e-6 s. Ours are taken at a hundred times that step, 0.1 ms, and at 1 ms, where the
// mass-bristle mode, sqrt(1e5 / 1) = 316 rad/s, still has 20 steps a cycle: one percent holds at both.
constexpr std::array<double, 2> kSteps{1e-4, 1e-3};
constexpr double kTolerance = 0.01;

/// The mass and friction of the 1995 set, physics.md section 3, on a spring to ground.
Plant::Parameters textbook(double spring) {
  Plant::Parameters parameters;
  parameters.mass = {1.0, 0.0, spring};
  ParamsOf<model::SlidingFriction, double> friction;
  friction.option = static_cast<int>(model::SlidingFriction::Law::lugre);
  friction.coulomb_forward = 1.0;
  friction.coulomb_backward = 1.0;
  friction.viscous_forward = 0.4;
  friction.viscous_backward = 0.4;
  friction.stiffness = 1e5;
  friction.static_ratio = 1.5;
  friction.stribeck_velocity = 1e-3;
  friction.damping = 316.2;
  activate<model::SlidingFriction, Plant>(parameters, friction);
  return parameters;
}

double friction_of(const Plant::State& state) {
  return state.effects.outputs[index_in<model::SlidingFriction>(Plant::Effects{})];
}

/// First peak of the friction force while the applied force rises at `rate` [N/s].
double break_away(double rate, double h) {
  const Plant plant(textbook(0.0), h);
  Plant::State state = plant.at_rest(0.0);
  double peak = 0.0;
  for (int k = 0; friction_of(state) >= 0.99 * peak; ++k) {
    plant.step(state, rate * (k + 0.5) * h);
    peak = std::max(peak, friction_of(state));
  }
  return peak;
}

struct StickSlip {
  double period = 0.0;
  double peak_speed = 0.0;
  double peak_force = 0.0;
};

/// The mass on a spring of 2 N/m whose end moves at 0.1 m/s, from the second slip to the fifth.
StickSlip stick_slip(double h) {
  constexpr double spring = 2.0;
  constexpr double speed = 0.1;
  const Plant plant(textbook(spring), h);
  Plant::State state = plant.at_rest(0.0);
  StickSlip result;
  std::vector<double> slips;
  bool slipping = false;
  for (int k = 0; slips.size() < 5; ++k) {
    plant.step(state, spring * speed * (k + 0.5) * h);
    const double time = (k + 1) * h;
    if (slips.size() >= 2) {
      result.peak_speed = std::max(result.peak_speed, state.y(1));
      result.peak_force = std::max(result.peak_force, spring * (speed * time - state.y(0)));
    }
    if (!slipping && state.y(1) > speed) {
      slips.push_back(time);
    }
    slipping = state.y(1) > (slipping ? 0.5 * speed : speed);
  }
  result.period = (slips[4] - slips[1]) / 3.0;
  return result;
}

void check(double expected, double value) { DOUBLES_EQUAL(expected, value, kTolerance * expected); }

}  // namespace

TEST_GROUP(LugreReference){};

TEST(LugreReference, BreaksAwayAtALowerForceWhenTheForceRisesFaster) {
  for (const double h : kSteps) {
    check(1.4324, break_away(1.0, h));
    check(1.3132, break_away(5.0, h));
    check(1.2200, break_away(10.0, h));
    check(1.0986, break_away(20.0, h));
  }
}

TEST(LugreReference, SticksAndSlipsOnASoftSpring) {
  for (const double h : kSteps) {
    const StickSlip motion = stick_slip(h);
    check(6.3627, motion.period);
    check(0.3698, motion.peak_speed);
    check(1.508, motion.peak_force);
  }
}

// 1.425 N is 95 % of the break-away force. Up at 0.1425 N/s, held for 5 s, down at the same rate.
TEST(LugreReference, SlidesALittleBeforeItBreaksAwayAndKeepsMostOfIt) {
  constexpr double rate = 0.1425;
  for (const double h : kSteps) {
    const Plant plant(textbook(0.0), h);
    Plant::State state = plant.at_rest(0.0);
    double at_the_top = 0.0;
    for (int k = 0; k * h < 25.0; ++k) {
      const double time = (k + 0.5) * h;
      if (time < 10.0) {
        at_the_top = state.y(0);
      }
      plant.step(state, std::clamp(time < 15.0 ? rate * time : rate * (25.0 - time), 0.0, 1.425));
    }
    check(44.9e-6, at_the_top);
    check(35.3e-6, state.y(0));
  }
}

}  // namespace hotfire::test
