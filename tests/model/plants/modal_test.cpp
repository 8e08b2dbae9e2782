// SPDX-License-Identifier: Apache-2.0
#include "model/modal.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <tuple>

#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Structure = model::Modal<double>;

constexpr double kHertz = 2.0 * std::numbers::pi;

Structure::Parameters two_modes() {
  Structure::Parameters parameters;
  std::get<0>(parameters.modes) = {5.0, 0.02, 0.1, 1.0, 0.4, 0.8, -0.5};
  std::get<1>(parameters.modes) = {12.0, 0.01, 0.05, -0.7, 1.2, 0.3, 1.5};
  return parameters;
}

}  // namespace

TEST_GROUP(Modal){};

// A force that is held over a step is a staircase of the sine: its mean is less by (w h)^2 / 24 and later by h / 2.
TEST(Modal, AnswersASineAsTheSumOfItsModesAtEveryPlaceAndInEveryDerivative) {
  constexpr double h = 1e-4;
  constexpr double w = 7.0 * kHertz;
  const Structure::Parameters parameters = two_modes();
  const Structure structure(parameters, h);
  Structure::State state = structure.at_rest(0.0);
  const auto expected = [&](std::size_t place) {
    std::complex<double> sum = 0.0;
    Structure::Parameters::for_each_part(parameters, [&](const auto& mode) {
      const double natural = kHertz * mode.frequency;
      const double shape = place == 0 ? 1.0 : place == 1 ? mode.place2 : mode.place3;
      sum += shape * mode.mobility * mode.drive /
             std::complex<double>(natural * natural - w * w, 2.0 * mode.damping_ratio * natural * w);
    });
    return sum;
  };
  double worst = 0.0;
  for (int k = 0; k * h < 40.0; ++k) {
    structure.step(state, std::sin(w * (k + 0.5) * h));
    if (k * h < 39.0) {
      continue;
    }
    const std::complex<double> turn = std::polar(1.0, w * (k + 1) * h);
    for (std::size_t place = 0; place < 3; ++place) {
      const std::complex<double> position = expected(place) * turn;
      const double size = std::abs(position);
      worst = std::max(worst, std::abs(Structure::measured(state)[3 * place] - position.imag()) / size);
      worst = std::max(worst, std::abs(Structure::measured(state)[3 * place + 1] - w * position.real()) / (w * size));
      worst =
          std::max(worst, std::abs(Structure::measured(state)[3 * place + 2] + w * w * position.imag()) / (w * w * size));
    }
  }
  // The continued acceleration is off by (w h)^2 / 3; its place between samples adds another part as large.
  CHECK_TRUE(worst < (w * h) * (w * h));
}

// One mode with everything at one place is a mass on a spring: J = 1 / mobility. Both read the same
// equation in the same way.
TEST(Modal, OneModeIsADirectMassWithTheSameEffect) {
  constexpr double h = 5e-4;
  Structure::Parameters one;
  std::get<0>(one.modes) = {4.0, 0.03, 0.5, 1.0, 1.0, 0.0, 0.0};
  model::Direct<double>::Parameters mass;
  const double w = 4.0 * kHertz;
  mass.mass = {2.0, 2.0 * 0.03 * w * 2.0, w * w * 2.0};
  ParamsOf<model::CubicStiffness, double> cubic;
  cubic.stiffness = 3e5;
  activate<model::CubicStiffness, Structure>(one, cubic);
  activate<model::CubicStiffness, model::Direct<double>>(mass, cubic);
  const Structure structure(one, h);
  const model::Direct<double> direct(mass, h);
  Structure::State state = structure.at_rest(0.0);
  model::Direct<double>::State other = direct.at_rest(0.0);
  double largest = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double force = 60.0 * std::sin(20.0 * k * h);
    structure.step(state, force);
    direct.step(other, force);
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = model::Direct<double>::measured(other)[c];
      largest = std::max(largest, std::abs(value));
      DOUBLES_EQUAL(value, Structure::measured(state)[c], 1e-9 * largest);
    }
  }
  DOUBLES_EQUAL(structure.joint_position(state), Structure::measured(state)[0], 0.0);
  DOUBLES_EQUAL(structure.joint_rate(state), Structure::measured(state)[1], 0.0);
}

// Rigid friction across the joint above what would move it holds the joint still: its modes move as one constrained body.
TEST(Modal, FrictionThatIsNotOvercomeHoldsTheJointStill) {
  Structure::Parameters parameters = two_modes();
  ParamsOf<model::SlidingFriction, double> friction;
  friction.coulomb_forward = friction.coulomb_backward = 1e3;
  activate<model::SlidingFriction, Structure>(parameters, friction);
  const Structure structure(parameters, 5e-4);
  Structure::State state = structure.at_rest(0.0);
  double moved = 0.0;
  double joint = 0.0;
  for (int k = 0; k < 4000; ++k) {
    structure.step(state, 10.0 * std::sin(7.0 * kHertz * 5e-4 * k));
    moved = std::max(moved, std::abs(Structure::measured(state)[0]));
    joint = std::max(joint, std::abs(structure.joint_position(state)));
  }
  CHECK_TRUE(moved > 1e-6);
  CHECK_TRUE(joint < 1e-9 * moved);
}

// Dry friction jumps where the joint turns, here in one of a hundred steps. A mean of the last step, continued to its end,
// is off by the whole jump in the step of a turn and by half of it in the next: by sqrt(1.25 / 100) = 0.11 of it at least.
TEST(Modal, AccelerationUnderDryFrictionIsThatOfTheEquationAlsoAfterATurn) {
  constexpr double h = 5e-4;
  constexpr int kFiner = 50;
  constexpr double kLevel = 5.0;
  Structure::Parameters parameters = two_modes();
  ParamsOf<model::SlidingFriction, double> friction;
  friction.coulomb_forward = friction.coulomb_backward = kLevel;
  activate<model::SlidingFriction, Structure>(parameters, friction);
  const Structure structure(parameters, h);
  const Structure finer(parameters, h / kFiner);
  Structure::State state = structure.at_rest(0.0);
  Structure::State of_finer = finer.at_rest(0.0);
  const auto force = [](double t) { return 40.0 * std::sin(9.0 * kHertz * t) + 25.0 * std::sin(23.0 * kHertz * t); };
  double square = 0.0;
  int turns = 0;
  constexpr int kSteps = 8000;
  for (int k = 0; k < kSteps; ++k) {
    const double rate = structure.joint_rate(state);
    structure.step(state, force((k + 0.5) * h));
    turns += rate * structure.joint_rate(state) < 0.0 ? 1 : 0;
    for (int i = 0; i < kFiner; ++i) {
      finer.step(of_finer, force((k + (i + 0.5) / kFiner) * h));
    }
    const double missed = Structure::measured(state)[2] - Structure::measured(of_finer)[2];
    square += missed * missed;
  }
  const auto& [first, second] = std::tie(std::get<0>(parameters.modes), std::get<1>(parameters.modes));
  const double jump = kLevel * (first.mobility * first.joint + second.mobility * second.joint);
  CHECK_TRUE(turns > kSteps / 150);
  CHECK_TRUE(std::sqrt(square / kSteps) < 0.07 * jump);
}

}  // namespace hotfire::test
