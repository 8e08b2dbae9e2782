// SPDX-License-Identifier: Apache-2.0
#include "model/electromechanical.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/checks.hpp"
#include "tests/model/support/plants.hpp"
#include "tests/model/support/servo_reference.hpp"

namespace hotfire::test {
namespace {

using Actuator = model::Electromechanical<double>;

template <class E, class Plant>
void set_active(typename Plant::Parameters& parameters, bool active) {
  parameters.effects.active[index_in<E>(typename Plant::Effects{})] = active;
}

/// The largest difference of each reading from the reference over half a second under a setpoint that steps, over the
/// largest reading. `h`: step of the plant.
std::array<double, 5> worst_error(const Actuator::Parameters& parameters, const ServoReference& reference, double h) {
  constexpr int kFine = 50;
  const Actuator plant(parameters, h);
  Actuator::State state = plant.steady(0.0);
  ServoReference::Vector y{};
  std::array<double, 5> worst{};
  std::array<double, 5> largest{};
  const int steps = static_cast<int>(std::lround(0.5 / h));
  for (int k = 0; k < steps; ++k) {
    const double setpoint = k * h < 0.2499 ? 0.3 : -0.1;
    plant.step(state, setpoint);
    for (int i = 0; i < kFine; ++i) {
      reference.advance(y, setpoint, h / kFine);
    }
    const std::array<double, 5> expected = ServoReference::readings(y);
    for (std::size_t c = 0; c < expected.size(); ++c) {
      worst[c] = std::max(worst[c], std::abs(Actuator::measured(state)[c] - expected[c]));
      largest[c] = std::max(largest[c], std::abs(expected[c]));
    }
  }
  for (std::size_t c = 0; c < worst.size(); ++c) {
    worst[c] /= largest[c];
  }
  return worst;
}

}  // namespace

TEST_GROUP(Electromechanical){};

// The linear part is held exactly; the reference is off by (w h / 50)^4 of its fastest part, the winding's 1,000 rad/s.
TEST(Electromechanical, IsExactWhereItIsLinear) {
  const auto voltage = servo();
  auto current = servo();
  current.motor = {0.1, 1e-4, 1e-4, 3000.0, 0.0, 0.0};
  current.controller = {8.0, 20.0, 0.1, 1.0, 0.02, 0.0, 0.0};
  for (const auto& parameters : {voltage, current}) {
    const ServoReference reference(parameters);
    for (const double error : worst_error(parameters, reference, 5e-4)) {
      CHECK_TRUE(error < 1e-7);
    }
  }
}

// Laws that are smooth: a cubic spring and a damping by position at the load.
TEST(Electromechanical, IsSecondOrderUnderEffects) {
  auto parameters = servo();
  ParamsOf<model::CubicStiffness, double> cubic;
  cubic.stiffness = 8e3;
  activate<model::CubicStiffness, Actuator>(parameters, cubic);
  const ServoReference reference(parameters, {.on_load = [](double x, double) { return 8e3 * x * x * x; }});
  const auto coarse = worst_error(parameters, reference, 5e-4);
  const auto fine = worst_error(parameters, reference, 2.5e-4);
  for (std::size_t c = 0; c < coarse.size(); ++c) {
    CHECK_TRUE(coarse[c] < 2e-4);
    CHECK_TRUE(coarse[c] > 3.3 * fine[c]);
    CHECK_TRUE(coarse[c] < 4.7 * fine[c]);
  }
}

// Dry friction on both sides of the transmission, against the reference with the sign of the speed spread over 1e-4 of the
// largest: the plant's own jump falls anywhere in a step, so the speeds are right to a step's change of it.
TEST(Electromechanical, TakesFrictionOnBothSidesOfTheTransmission) {
  auto parameters = servo();
  ParamsOf<model::MotorFriction, double> of_motor;
  of_motor.coulomb_forward = of_motor.coulomb_backward = 40.0;
  ParamsOf<model::SlidingFriction, double> of_load;
  of_load.coulomb_forward = of_load.coulomb_backward = 25.0;
  activate<model::MotorFriction, Actuator>(parameters, of_motor);
  activate<model::SlidingFriction, Actuator>(parameters, of_load);
  const auto dry = [](double level) { return [=](double, double v) { return level * std::tanh(v / 1e-3); }; };
  const ServoReference both(parameters, {.on_motor = dry(40.0), .on_load = dry(25.0)});
  const ServoReference one(parameters, {.on_motor = dry(40.0)});
  const auto error = worst_error(parameters, both, 1e-4);
  CHECK_TRUE(error[Actuator::kPosition] < 1e-3);
  CHECK_TRUE(error[Actuator::kMotorPosition] < 1e-3);
  CHECK_TRUE(worst_error(parameters, one, 1e-4)[Actuator::kPosition] > 5e-3);
}

// The spring that play takes out is that at the mean of the step's ends: (w h)^2 / 12 of it remains, 4e-5.
TEST(Electromechanical, PlayLeavesTheLoadWhereItIsUntilItIsTakenUp) {
  auto parameters = servo();
  parameters.controller = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  parameters.mass.stiffness = 0.0;
  ParamsOf<model::BacklashAt<model::Site::transmission>, double> play;
  play.half_width = 0.01;
  activate<model::BacklashAt<model::Site::transmission>, Actuator>(parameters, play);
  parameters.transmission.damping = 0.0;
  const Actuator plant(parameters, 1e-4);
  Actuator::State state = plant.steady(0.0);
  double before = 0.0;
  while (Actuator::measured(state)[Actuator::kMotorPosition] / 100.0 < 0.0099) {
    plant.step(state, 2.0);
    before = std::max(before, std::abs(Actuator::measured(state)[Actuator::kPosition]));
  }
  for (int k = 0; k < 5000; ++k) {
    plant.step(state, 2.0);
  }
  DOUBLES_EQUAL(0.0, before, 1e-6);
  CHECK_TRUE(Actuator::measured(state)[Actuator::kPosition] > 0.05);
}

// A stiff transmission is nearly a rigid one: their readings differ by its deflection, load over stiffness.
TEST(Electromechanical, RigidTransmissionIsTheLimitOfAStiffOne) {
  auto stiff = servo();
  stiff.transmission.stiffness = 2e7;
  stiff.transmission.damping = 50.0;
  auto rigid = servo();
  rigid.transmission.stiffness = 0.0;
  rigid.transmission.damping = 0.0;
  const Actuator elastic(stiff, 1e-5);
  const Actuator one(rigid, 1e-5);
  Actuator::State a = elastic.steady(0.0);
  Actuator::State b = one.steady(0.0);
  for (int k = 0; k < 30000; ++k) {
    elastic.step(a, 0.3);
    one.step(b, 0.3);
    DOUBLES_EQUAL(Actuator::measured(b)[Actuator::kPosition], Actuator::measured(a)[Actuator::kPosition], 1e-4);
  }
}

// A limit that is held over a step, while the loop around it would answer within the step, has to be solved with its own
// feedback. The loops are as fast as rigs have them; the reference limits at every one of its 20 us.
TEST(Electromechanical, FollowsTheReferenceUnderALimitAlsoInAFastLoop) {
  for (const double speed_loop : {100.0, 400.0, 1200.0}) {
    auto parameters = servo();
    parameters.motor = {0.1, 1e-4, 1e-4, 6000.0, 0.0, 0.0};
    // Crossover of the speed loop at the motor, over its reflected inertia.
    const double gain = speed_loop * 1e-4 * 100.0 / 0.1;
    parameters.controller = {20.0 * gain, 0.0, 0.0, 1.0, 0.05, 0.0, 5.0};
    const double h = Actuator::longest_step(parameters);
    CHECK_TRUE(h <= 0.2 / speed_loop + 1e-12);
    const Actuator plant(parameters, h);
    const ServoReference reference(parameters);
    Actuator::State state = plant.steady(0.0);
    ServoReference::Vector y{};
    double limited = 0.0;
    double current = 0.0;
    double error = 0.0;
    const int steps = static_cast<int>(0.5 / h);
    for (int k = 0; k < steps; ++k) {
      plant.step(state, 0.3);
      for (int i = 0; i < 20; ++i) {
        reference.advance(y, 0.3, h / 20.0);
      }
      limited += std::abs(plant.motor_command(state)) >= 5.0 ? 1.0 : 0.0;
      current = std::max(current, std::abs(Actuator::measured(state)[Actuator::kCurrent]));
      error = std::max(error, std::abs(Actuator::measured(state)[Actuator::kPosition] - y[4]));
    }
    CHECK_TRUE(limited > 0.1 * steps);
    CHECK_TRUE(limited < 0.95 * steps);
    CHECK_TRUE(current < 5.5);
    CHECK_TRUE(error < 1e-3 * std::abs(y[4]));
  }
}

// The drive can give 24 V. An error of some 3 would add 1.5e-3 a step to the integral. While it waits, what it stops is the
// error at the mean of the step's ends, which is its mean over the step but for (w h)^2 / 12.
TEST(Electromechanical, IntegralWaitsWhileTheCommandIsLimited) {
  auto limited = servo();
  limited.controller.limit = 24.0;
  const Actuator plant(limited, 5e-4);
  Actuator::State state = plant.steady(0.0);
  double stored = 0.0;
  int waited = 0;
  for (int k = 0; k < 200; ++k) {
    plant.step(state, 3.0);
    if (std::abs(plant.motor_command(state)) >= 24.0 && k > 0) {
      DOUBLES_EQUAL(stored, state.y(Actuator::kIntegral), 1e-6);
      ++waited;
    }
    stored = state.y(Actuator::kIntegral);
  }
  CHECK_TRUE(waited > 100);
  CHECK_TRUE(std::abs(stored) < 0.01);
}

TEST(Electromechanical, RestsWhereItIsSetUp) {
  struct Rest {
    Actuator::Parameters parameters;
    double setpoint;
  };
  std::vector<Rest> rests{{servo(), 0.2}, {servo(), -0.1}};
  rests[1].parameters.controller.integral_gain = 0.0;
  for (const double share : {0.0, 1.0}) {
    rests.push_back(rests[0]);
    rests.back().parameters.controller.load_feedback = share;
    rests.push_back(rests[1]);
    rests.back().parameters.controller.load_feedback = share;
  }
  // Open: a voltage against the spring to ground.
  rests.push_back({servo(), 2.0});
  rests.back().parameters.controller = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const std::size_t plain = rests.size();
  for (std::size_t i = 0; i < plain; ++i) {
    auto under_load = rests[i];
    ParamsOf<model::ForceOffset, double> offset;
    offset.force = 12.0;
    activate<model::ForceOffset, Actuator>(under_load.parameters, offset);
    rests.push_back(under_load);
    ParamsOf<model::BacklashAt<model::Site::transmission>, double> play;
    play.half_width = 2e-3;
    activate<model::BacklashAt<model::Site::transmission>, Actuator>(under_load.parameters, play);
    ParamsOf<model::DriveDeadbandAt<model::Site::drive>, double> dead;
    dead.half_width = 0.3;
    activate<model::DriveDeadbandAt<model::Site::drive>, Actuator>(under_load.parameters, dead);
    rests.push_back(under_load);
  }
  for (const Rest& rest : rests) {
    for (const bool rigid : {false, true}) {
      auto own = rest.parameters;
      if (rigid) {
        own.transmission.stiffness = own.transmission.damping = 0.0;
        set_active<model::BacklashAt<model::Site::transmission>, Actuator>(own, false);
      }
      const Actuator plant(own, 5e-4);
      Actuator::State state = plant.steady(rest.setpoint);
      const auto start = Actuator::measured(state);
      CHECK_TRUE(std::abs(start[Actuator::kPosition]) > 1e-3);
      for (int k = 0; k < 1000; ++k) {
        plant.step(state, rest.setpoint);
      }
      for (std::size_t c = 0; c < start.size(); ++c) {
        DOUBLES_EQUAL(start[c], Actuator::measured(state)[c], 1e-7 * (1.0 + std::abs(start[c])));
      }
    }
  }
}

// Nothing but the record says where in its play a motor rests.
TEST(Electromechanical, MotorStartsWhereItIsInItsPlay) {
  auto parameters = servo();
  ParamsOf<model::BacklashAt<model::Site::transmission>, double> play;
  play.half_width = 1e-3;
  activate<model::BacklashAt<model::Site::transmission>, Actuator>(parameters, play);
  const Actuator plant(parameters, 5e-4);
  const double inside = 0.04;
  DOUBLES_EQUAL(inside, Actuator::measured(plant.resting(0.0, 0.0, &inside))[Actuator::kMotorPosition], 1e-15);
  // Beyond it the load decides: 300 N/m at 0.1 m on 2e4 N/m.
  const double beyond = 20.0;
  DOUBLES_EQUAL(100.0 * (0.1 + 1e-3 + 0.0015),
                Actuator::measured(plant.resting(0.1, 0.1, &beyond))[Actuator::kMotorPosition], 1e-6);
}

TEST(Electromechanical, StartsAtZeroWhereNothingHoldsIt) {
  auto parameters = servo();
  parameters.controller = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  parameters.mass.stiffness = 0.0;
  DOUBLES_EQUAL(0.0, Actuator::measured(Actuator(parameters, 5e-4).steady(0.3))[Actuator::kPosition], 0.0);
}

TEST(Electromechanical, RefusesAMotorWithoutADriveAndPlayInARigidTransmission) {
  auto parameters = servo();
  CHECK_TRUE(model::broken_part(parameters).relation.empty());
  CHECK_TRUE(model::broken_effect(parameters).relation.empty());
  parameters.motor.current_corner = 100.0;
  CHECK_TRUE(model::broken_part(parameters).name == "motor");
  parameters.motor = {0.1, 1e-4, 1e-4, 0.0, 1.0, 0.0};
  CHECK_TRUE(model::broken_part(parameters).name == "motor");
  parameters = servo();
  parameters.transmission.stiffness = 0.0;
  activate<model::MotorFriction, Actuator>(parameters, {});
  CHECK_TRUE(model::broken_effect(parameters).name == "motor_friction");
  parameters = servo();
  parameters.transmission.stiffness = 0.0;
  activate<model::BacklashAt<model::Site::transmission>, Actuator>(parameters, {});
  CHECK_TRUE(model::broken_effect(parameters).name == "backlash");
}

}  // namespace hotfire::test
