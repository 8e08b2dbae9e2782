// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/model/support/vehicles.hpp"

namespace hotfire::test {

namespace {

using Friction = model::BearingFriction<double>;
using Pair = model::Pair<double>;

constexpr double kBearingLoadStep = 5e-4;

/// Hot fire whose friction, structure, bearing and trim follow the thrust.
template <class Vehicle>
typename Vehicle::Parameters thrust_dependent(double thrust) {
  typename Vehicle::Parameters parameters = hot_fire<Vehicle>();
  for (auto& gimbal : parameters.gimbals) {
    gimbal.bearing.thrust = thrust;
    gimbal.bearing.rated_thrust = 1.86e6;
    gimbal.bearing.dead_load = -3.4e4;
    gimbal.bearing.unloaded_structure = 0.4;
    gimbal.bearing.unloaded_stiffness = 0.5;
    gimbal.bearing.load_scale = 8e5;
    gimbal.bearing.pitch_misalignment = 3e-3;
    gimbal.friction.coulomb_torque = 0.0;
    gimbal.friction.coefficient = 0.08;
  }
  return parameters;
}

/// Torque of steady sliding along pitch.
double sliding(const Friction& friction, double speed, double load) {
  Pair bristle;
  Pair torque;
  for (int k = 0; k < 4000; ++k) {
    torque = friction.torque(bristle, {{speed, 0.0}, {speed, 0.0}, {}, kBearingLoadStep}, {load, 1.0});
  }
  return torque.pitch;
}

/// Checks the friction of a plant under a command of pitch against mu N r, wherever the bearing has slid fast for so long
/// that neither the Stribeck rise nor the bristles' travel are left; returns at how many steps that was.
template <class Command>
int check_sliding(double thrust, Command&& command) {
  constexpr double kFast = 0.08;     // rad/s: eight times the Stribeck velocity
  constexpr int kStepsToSlide = 50;  // 2 mrad: ten times the travel of the bristles under full thrust
  const Taos::Parameters parameters = thrust_dependent<Taos>(thrust);
  const auto& friction = parameters.gimbals[0].friction;
  const auto plant = std::make_unique<Taos>(parameters, kBearingLoadStep);
  const auto state = std::make_unique<Taos::State>(plant->steady({}));
  Taos::Inputs inputs;
  int fast = 0;
  int checked = 0;
  for (int k = 0; k < 2000; ++k) {
    inputs.commands[0] = command(k * kBearingLoadStep);
    plant->step(*state, inputs);
    fast = std::abs(state->axes[0].y(Taos::AxisModel::kAngleRate)) > kFast ? fast + 1 : 0;
    if (fast < kStepsToSlide) {
      continue;
    }
    const auto pose =
        plant->geometry(0).at(state->axes[0].y(Taos::AxisModel::kAngle), state->axes[1].y(Taos::AxisModel::kAngle));
    const model::Vector3<double> load = pose.thrust * (thrust + parameters.gimbals[0].bearing.dead_load) +
                                        pose.direction[0] * state->axes[0].spring_force +
                                        pose.direction[1] * state->axes[1].spring_force;
    const double expected = friction.coefficient * friction.radius * load.norm();
    DOUBLES_EQUAL(expected, state->gimbals[0].torque.length(), 0.01 * expected);
    ++checked;
  }
  return checked;
}

}  // namespace

TEST_GROUP(BearingUnderLoad){};

TEST(BearingUnderLoad, RubsByMuNRInStepsAndSinesWithoutThrustAndUnderIt) {
  const auto step = [](double time) { return time < 0.1 ? 0.0 : 0.03; };
  const auto sine = [](double time) { return 0.014 * std::sin(2.0 * std::numbers::pi * 3.0 * time); };
  for (const double thrust : {0.0, 1.86e6}) {
    CHECK_TRUE(check_sliding(thrust, step) > 20);
    CHECK_TRUE(check_sliding(thrust, sine) > 100);
  }
}

TEST(BearingUnderLoad, RubsByItsConstantTorqueAndMuNR) {
  Friction friction{2, 1e3, 1e8, 1.2, 0.01, 3e3};
  friction.coefficient = 0.08;
  friction.radius = 0.13;
  for (const double load : {0.0, 3.4e4, 1.86e6}) {
    const double expected = 1e3 + 0.08 * 0.13 * load;
    DOUBLES_EQUAL(expected, sliding(friction, 0.2, load), 1e-6 * expected);
  }
}

TEST(BearingUnderLoad, ForgetsItsBristleWhereNothingRubs) {
  Friction friction{2, 0.0, 1e8};
  friction.coefficient = 0.08;
  Pair bristle{1e-4, -1e-4};
  const Pair torque = friction.torque(bristle, {{0.1, 0.0}, {0.1, 0.0}, {}, kBearingLoadStep}, {0.0, 1.0});
  DOUBLES_EQUAL(0.0, torque.length(), 0.0);
  DOUBLES_EQUAL(0.0, bristle.length(), 0.0);
}

TEST(BearingUnderLoad, AddsTheViscousTorqueOfTheSlip) {
  Friction friction{2, 2e4, 1e8};
  const double without = sliding(friction, 0.2, 0.0);
  friction.viscous = 5e3;
  DOUBLES_EQUAL(without + 5e3 * 0.2, sliding(friction, 0.2, 0.0), 1e-6 * without);
}

// Against dT/dx = sigma0 (1 - T / level)^exponent, integrated by Heun's method in a hundredth of the steps.
TEST(BearingUnderLoad, YieldsByDahlsExponent) {
  constexpr double kLevel = 2e4;
  constexpr double kStiffness = 1e7;
  constexpr double kSpeed = 0.02;
  for (const double exponent : {1.0, 1.5, 2.0, 3.0}) {
    Friction friction{1, kLevel, kStiffness};
    friction.exponent = exponent;
    Pair bristle;
    double torque = 0.0;
    double reference = 0.0;
    const auto slope = [&](double t) { return kStiffness * kSpeed * std::pow(std::max(0.0, 1.0 - t / kLevel), exponent); };
    for (int k = 0; k < 400; ++k) {
      friction.torque(bristle, {{kSpeed, 0.0}, {kSpeed, 0.0}, {}, kBearingLoadStep});
      torque = kStiffness * bristle.pitch;
      for (int i = 0; i < 100; ++i) {
        const double first = slope(reference);
        reference += 0.5 * kBearingLoadStep / 100.0 * (first + slope(reference + kBearingLoadStep / 100.0 * first));
      }
      DOUBLES_EQUAL(reference, torque, 0.01 * kLevel);
    }
    CHECK_TRUE(torque > 0.5 * kLevel);
  }
}

// The displacement is the gradient of an energy: around a closed loop of forces it gives and takes nothing.
TEST(BearingUnderLoad, MakesNoWorkAroundALoopOfForces) {
  model::GimbalParameters<double> gimbal;
  gimbal.compliant = true;
  gimbal.stiffness = bearing_stiffness();
  gimbal.stiffness(1, 1) = 5e8;
  gimbal.bearing.unloaded_stiffness = 0.2;
  gimbal.bearing.load_scale = 5e5;
  const model::GimbalSpring<double> spring(gimbal, kBearingLoadStep);
  constexpr int kPoints = 20000;
  const auto force_at = [](int k) {
    const double angle = 2.0 * std::numbers::pi * k / kPoints;
    return model::Vector3<double>{2e5 + 4e5 * std::cos(angle), 3e5 * std::sin(angle), 2e5 * std::sin(2.0 * angle)};
  };
  double work = 0.0;
  double exchanged = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const model::Vector3<double> mean = 0.5 * (force_at(k) + force_at(k + 1));
    const double part = mean.dot((spring.settled(force_at(k + 1), {}) - spring.settled(force_at(k), {})).head<3>());
    work += part;
    exchanged += std::abs(part);
  }
  CHECK_TRUE(exchanged > 100.0);
  DOUBLES_EQUAL(0.0, work, 1e-4 * exchanged);
}

TEST(BearingUnderLoad, IsSofterWithoutIt) {
  model::GimbalParameters<double> gimbal;
  gimbal.compliant = true;
  gimbal.stiffness = bearing_stiffness();
  gimbal.bearing.unloaded_stiffness = 0.2;
  gimbal.bearing.load_scale = 5e5;
  const model::GimbalSpring<double> spring(gimbal, kBearingLoadStep);
  DOUBLES_EQUAL(5.0, spring.softness({0.0, 0.0, 0.0}), 1e-12);
  DOUBLES_EQUAL(1.0 + 4.0 * std::exp(-1.0), spring.softness({5e5, 0.0, 0.0}), 1e-9);
  DOUBLES_EQUAL(1.0, spring.softness({3e6, 0.0, 0.0}), 1e-9);
}

// A step's thrust is the declared one and what is put in: it does not matter which of them says it.
TEST(BearingUnderLoad, DoesNotMatterWhetherThrustIsDeclaredOrPutIn) {
  for (const double thrust : {0.0, 0.9e6, 1.86e6}) {
    const auto declared = std::make_unique<Taos>(thrust_dependent<Taos>(thrust), kBearingLoadStep);
    const auto put_in = std::make_unique<Taos>(thrust_dependent<Taos>(1.86e6), kBearingLoadStep);
    Taos::State one = declared->steady({});
    Taos::State other = put_in->steady({}, {thrust - 1.86e6});
    Taos::Inputs inputs;
    double largest = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const double time = k * kBearingLoadStep;
      inputs.thrust = {};
      inputs.commands = {0.01 * std::sin(40.0 * time), 0.007 * std::sin(25.0 * time)};
      declared->step(one, inputs);
      inputs.thrust = {thrust - 1.86e6};
      put_in->step(other, inputs);
      for (std::size_t channel = 0; channel < one.measured.size(); ++channel) {
        DOUBLES_EQUAL(one.measured[channel], other.measured[channel], 1e-9 * std::abs(one.measured[channel]) + 1e-9);
        largest = std::max(largest, std::abs(one.measured[channel]));
      }
    }
    CHECK_TRUE(std::isfinite(largest));
  }
}

namespace {

/// Angles of pitch [rad] over a second of two sines, as a plant with these parameters moves under what `act` puts in.
template <class Act>
std::vector<double> pitch_of(const Taos::Parameters& parameters, Act&& act) {
  const auto plant = std::make_unique<Taos>(parameters, kBearingLoadStep);
  const auto state = std::make_unique<Taos::State>(plant->steady({}));
  Taos::Inputs inputs;
  std::vector<double> angles;
  for (int k = 0; k < 2000; ++k) {
    const double time = k * kBearingLoadStep;
    inputs.commands = {0.01 * std::sin(20.0 * time), 0.007 * std::sin(13.0 * time)};
    act(*plant, *state, inputs);
    plant->step(*state, inputs);
    angles.push_back(state->axes[0].y(Taos::AxisModel::kAngle));
  }
  return angles;
}

double largest_difference(const std::vector<double>& one, const std::vector<double>& other) {
  double largest = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    largest = std::max(largest, std::abs(one[k] - other[k]));
  }
  return largest;
}

}  // namespace

TEST(BearingUnderLoad, IsLoadedByAForceAsByAThrust) {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.gimbals[0].friction.coulomb_torque = 0.0;
  parameters.gimbals[0].friction.coefficient = 0.08;
  static constexpr double kMore = 1e6;
  const auto nothing = [](const auto&, const auto&, auto&) {};
  const auto thrust = [](const auto&, const auto&, Taos::Inputs& inputs) { inputs.thrust = {kMore}; };
  const auto force = [](const Taos& plant, const Taos::State& state, Taos::Inputs& inputs) {
    const auto& angle = Taos::AxisModel::kAngle;
    inputs.force[0] = kMore * plant.geometry(0).at(state.axes[0].y(angle), state.axes[1].y(angle)).thrust;
  };
  const std::vector<double> of_thrust = pitch_of(parameters, thrust);
  const double moved = largest_difference(of_thrust, pitch_of(parameters, nothing));
  CHECK_TRUE(moved > 1e-4);
  // A step's thrust turns with the engine within the step, the force does not.
  DOUBLES_EQUAL(0.0, largest_difference(of_thrust, pitch_of(parameters, force)), 0.01 * moved);
}

TEST(BearingUnderLoad, VibratesInProportionToTheThrust) {
  constexpr double kHalf = 0.93e6;
  const auto under_half = [](double rated, double velocity) {
    Taos::Parameters parameters = hot_fire<Taos>();
    auto& gimbal = parameters.gimbals[0];
    gimbal.bearing.thrust = kHalf;
    gimbal.bearing.rated_thrust = rated;
    gimbal.vibration = {velocity, velocity, 60.0};
    return pitch_of(parameters, [](const auto&, const auto&, auto&) {});
  };
  const std::vector<double> half = under_half(2.0 * kHalf, 0.4);
  DOUBLES_EQUAL(0.0, largest_difference(half, under_half(kHalf, 0.2)), 1e-12);
  CHECK_TRUE(largest_difference(half, under_half(kHalf, 0.4)) > 1e-4);
}

TEST(BearingUnderLoad, IsWhatATorqueOnTheEngineIsThatAnEffectNames) {
  Taos::Parameters parameters = hot_fire<Taos>();
  const auto pushed = std::make_unique<Taos>(parameters, kBearingLoadStep);
  activate_in<model::TorqueOffset, Taos>(parameters, 0, {0, -5e3});
  const auto named = std::make_unique<Taos>(parameters, kBearingLoadStep);
  Taos::State one = pushed->steady({});
  Taos::State other = one;
  Taos::Inputs inputs;
  for (int k = 0; k < 400; ++k) {
    inputs.torque[0] = 5e3;
    pushed->step(one, inputs);
    inputs.torque[0] = 0.0;
    named->step(other, inputs);
  }
  CHECK_TRUE(one.measured[1] > 1e-5);
  DOUBLES_EQUAL(other.measured[1], one.measured[1], 1e-9);
}

TEST(BearingUnderLoad, RefusesAStructureThatFollowsNoThrust) {
  model::GimbalParameters<double> gimbal;
  gimbal.bearing.unloaded_structure = 0.5;
  CHECK_FALSE(model::broken_relation(gimbal).empty());
  gimbal.bearing.rated_thrust = 1.86e6;
  CHECK_TRUE(model::broken_relation(gimbal).empty());
}

}  // namespace hotfire::test
