// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/term_constant.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/terms/assessed.hpp"

using namespace hotfire;
using namespace hotfire::explain;

namespace {

using PistonReading = model::Term<model::Site::sensor, 0>;
using Command = model::Term<model::Site::command>;

/// The declared model with a curve over the position, which adds `constant` everywhere and a bend on top of it.
template <class E>
Fitted with_curve(double constant, double size, Candidate& candidate) {
  Fitted fitted = test::about_declared();
  const std::size_t place = test::add_effect<E>(std::get<SimplexParameters>(fitted.base), [&](auto& effect) {
    effect.argument = static_cast<int>(model::Argument::position);
    effect.table.points = 3;
    effect.table.x = {-0.01, 0.0, 0.01};
    effect.table.y = {constant, constant + size, constant};
  });
  candidate = {place, 0, std::string(E::name), "", std::string(model::site_name(E::site))};
  return fitted;
}

template <class E>
double first_ordinate(const Fitted& fitted) {
  double ordinate = 0.0;
  visit_effects(fitted.base, [&]<class Own>(std::size_t, const auto& effect) {
    if constexpr (std::is_same_v<Own, E>) {
      ordinate = effect.table.y[0];
    }
  });
  return ordinate;
}

/// What a curve that is `constant` too high becomes, of records of the curve without it.
template <class E>
double chosen_constant(double constant, double size) {
  Candidate candidate;
  ModelFile truth = test::declared();
  truth.parameters = with_curve<E>(0.0, size, candidate).base;
  const Dataset data = test::data_of(truth, 2);
  const Evaluator fine(data, Resolution::fine);
  const Assessed wrong = assess(fine, 1, with_curve<E>(constant, size, candidate));
  CHECK(wrong.good());
  const Assessed right = assess(fine, 1, with_chosen_constant(data, wrong.zeros, wrong.model, candidate).value());
  CHECK(right.good());
  DOUBLES_EQUAL(1.0, Goodness::combined(right.goodness.fitted), 0.05);
  return first_ordinate<E>(right.model);
}

}  // namespace

TEST_GROUP(TermConstant){};

// The zeros are those of noise over ten thousand rows: a hundredth of it.
TEST(TermConstant, CurveOfAReadingHasTheConstantWithWhichTheRecordsHaveNoZero) {
  for (const double constant : {-3e-4, 3e-4}) {
    DOUBLES_EQUAL(0.0, chosen_constant<PistonReading>(constant, 1e-4), 0.1 * test::kPistonNoise);
  }
}

TEST(TermConstant, CurveOfASignalToo) {
  // A constant of the command moves piston and engine: 1 mrad is 0.7 mm of stroke.
  DOUBLES_EQUAL(0.0, chosen_constant<Command>(1e-3, 2e-4), 1e-5);
}

TEST(TermConstant, IntervalsOfACurveAreThoseOfItsShape) {
  Candidate candidate;
  Fitted fitted = with_curve<PistonReading>(3e-4, 1e-4, candidate);
  fitted.free.clear();
  fitted.u.clear();
  for (const FreeParameter& p : effect_parameters(fitted.base, candidate, {})) {
    if (p.is_ordinate()) {
      fitted.free.push_back(p);
      fitted.u.push_back(p.coordinate(3e-4));
    }
  }
  CHECK_EQUAL(3U, fitted.free.size());
  // Differences of ordinates are known to a micrometre, their mean is not.
  const double precision = fitted.free[0].unit_size / 1e-6;
  fitted.normal = precision * precision * (Eigen::MatrixXd::Identity(3, 3) - Eigen::MatrixXd::Constant(3, 3, 1.0 / 3.0));
  for (const Estimate& estimate : estimates(fitted.free, fitted.u, fitted.normal)) {
    CHECK(!estimate.interval);
  }
  const Dataset data = test::data_of(test::declared());
  const Fitted given = with_chosen_constant(data, {{-1e-4, 0.0, 0.0}}, fitted, candidate).value();
  for (const Estimate& estimate : estimates(given.free, given.u, given.normal)) {
    CHECK(estimate.interval.has_value());
    DOUBLES_EQUAL(2e-4, estimate.value, 1e-9);
    DOUBLES_EQUAL(2.0 * 1.96e-6, estimate.interval->second - estimate.interval->first, 1e-6);
  }
}

TEST(TermConstant, ACurveInFrontOfAMemoryThatForgetsConstantsIsZeroAtZero) {
  Candidate candidate;
  const Fitted fitted = with_curve<PistonReading>(3e-4, 1e-4, candidate);
  const Dataset data = test::data_of(test::declared());
  candidate.choices = {static_cast<int>(model::Argument::position), 0, static_cast<int>(model::term::Order::curve_first)};
  for (const model::Memory memory : {model::Memory::washout, model::Memory::band_pass}) {
    candidate.option = static_cast<int>(memory);
    // The highest of its three points is at zero.
    const Fitted given = with_chosen_constant(data, {{0.0, 0.0, 0.0}}, fitted, candidate).value();
    DOUBLES_EQUAL(-1e-4, first_ordinate<PistonReading>(given), 1e-12);
  }
  candidate.option = static_cast<int>(model::Memory::lag);
  const Fitted kept = with_chosen_constant(data, {{0.0, 0.0, 0.0}}, fitted, candidate).value();
  DOUBLES_EQUAL(3e-4, first_ordinate<PistonReading>(kept), 1e-12);
}

TEST(TermConstant, ModelWithoutACurveStaysAsItIs) {
  Candidate candidate;
  Fitted fitted = with_curve<PistonReading>(0.0, 0.0, candidate);
  const Dataset data = test::data_of(test::declared());
  const Fitted same = with_chosen_constant(data, {{1e-3, 1e-3, 0.0}}, fitted, candidate).value_or(fitted);
  DOUBLES_EQUAL(0.0, first_ordinate<PistonReading>(same), 0.0);
}
