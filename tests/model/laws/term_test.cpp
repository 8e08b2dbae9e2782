// SPDX-License-Identifier: Apache-2.0
#include "model/effects/unlisted/term.hpp"

#include <CppUTest/TestHarness.h>

#include "model/simplex.hpp"
#include "tests/support/add_effect.hpp"

namespace {

namespace model = hotfire::model;
using hotfire::test::add_effect;

using hotfire::model::Argument;
using hotfire::model::Memory;
using hotfire::model::Signal;
using hotfire::model::Site;
using Reading = hotfire::model::Term<Site::sensor, 1>;

constexpr double kPeriod = 1e-3;  // s

/// A reading that a held one replaces, with a curve from -1 to 1 in front of the hold.
Reading::Params<double> held() {
  Reading::Params<double> term;
  term.option = static_cast<int>(Memory::hold);
  term.argument = static_cast<int>(Argument::angle);
  term.order = static_cast<int>(hotfire::model::term::Order::curve_first);
  term.time = kPeriod;
  term.direct = -1.0;
  term.table.points = 2;
  term.table.x = {-1.0, 1.0};
  term.table.y = {-1.0, 1.0};
  return term;
}

double read_at_rest(double value) {
  const Reading::Params<double> term = held();
  Reading::State<double> state;
  double reading = 0.0;
  for (int step = 0; step < 3; ++step) {
    reading = Reading::step(term, state, Signal<double>{value, kPeriod});
  }
  return reading;
}

TEST_GROUP(Term){};

TEST(Term, TermThatReplacesASignalReadsItsValueAtRest) { DOUBLES_EQUAL(0.5, read_at_rest(0.5), 1e-15); }

// The first reading is that of the start: a sample that is due after fifty steps is the reading after fifty steps.
TEST(Term, AHeldReadingOfAPlantIsThatOfTheTimeOfItsSample) {
  using Plant = model::Simplex<double>;
  constexpr int kSteps = 50;
  Plant::Parameters parameters;
  add_effect<Reading>(parameters, [](auto& term) {
    term = held();
    term.time = kSteps * kPeriod;
    term.gain = 1.0;
    term.table.points = 0;
  });
  const Plant plant(parameters, kPeriod);
  Plant::State state = plant.steady(0.0);
  double sample = state.y(Plant::kAngle);
  for (int step = 1; step < 10 * kSteps; ++step) {
    plant.step(state, 1e-4 * step);
    sample = step % kSteps == 0 ? state.y(Plant::kAngle) : sample;
    DOUBLES_EQUAL(sample, Plant::measured(state)[1], 1e-12);
  }
}

TEST(Term, BeyondTheCurveInFrontOfItsMemoryATermIsConstant) {
  // The signal itself passes: were `direct` to go on, it would stop at the curve's last value.
  DOUBLES_EQUAL(3.0, read_at_rest(3.0), 1e-15);
  DOUBLES_EQUAL(-3.0, read_at_rest(-3.0), 1e-15);
}

}  // namespace
