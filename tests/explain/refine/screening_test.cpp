// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/refine/screening.hpp"

#include <CppUTest/TestHarness.h>

#include <map>
#include <string>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/explain/oscillator.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/terms/trial.hpp"

namespace {

using namespace hotfire;
using explain::Screened;

/// Every candidate screened beside a model whose values are a fiftieth of a tolerance off the true ones: near enough for a
/// linear move, and as far off as to leave more than the noise.
std::vector<Screened> screened_beside_nearly_calibrated() {
  const ModelFile model = test::declared_oscillator(97.0);
  const explain::Dataset data = explain::make_dataset(model, {test::oscillator(0.0, 1e-3)});
  const explain::Evaluator evaluator(data, explain::Resolution::fine);
  const explain::Scales scales = explain::scales_of(model.parameters, data);
  explain::Fitted current;
  current.base = model.parameters;
  current.free = explain::declared_parameters(current.base, model.tolerance);
  const std::map<std::string, double> truth{{"mass.inertia", 1.0}, {"mass.damping", 1.5}, {"mass.stiffness", 100.0}};
  for (const explain::FreeParameter& parameter : current.free) {
    current.u.push_back(parameter.coordinate(truth.at(parameter.key)) + 0.02);
  }
  const explain::Screening screening(evaluator, current, scales, 2);
  return screening.run(explain::all_candidates(current.base, data), "screening", {});
}

/// The candidate of a name, screened beside the declared model.
Screened screened_alone(const std::string& name, const Record& record) {
  const ModelFile model = test::declared();
  const explain::Dataset data = explain::make_dataset(model, {record});
  const explain::Evaluator evaluator(data, explain::Resolution::coarse);
  const explain::Scales scales = explain::scales_of(model.parameters, data);
  explain::Fitted current;
  current.base = model.parameters;
  const explain::Screening screening(evaluator, current, scales, 1);
  std::vector<explain::Candidate> candidates = explain::all_candidates(current.base, data);
  std::erase_if(candidates, [&](const explain::Candidate& candidate) { return candidate.name != name; });
  return screening.run(candidates, "screening", {}).front();
}

}  // namespace

TEST_GROUP(Screening){};

TEST(Screening, WhatTheModelsOwnParametersGainBesideACandidateIsNotTheCandidates) {
  const auto screened = screened_beside_nearly_calibrated();
  CHECK_FALSE(screened.empty());
  for (const Screened& candidate : screened) {
    CHECK_TRUE(candidate.criterion > -explain::policy().strong_evidence);
  }
}

TEST(Screening, AFitOfOneParameterStartsInTheRippleOfItsErrorThatIsDeepest) {
  // Over the delay, the error has a ripple of 25 ms. The scan looks at 48 and at 80 ms, each in a ripple beside this one.
  constexpr double kDelay = 0.062;
  const Record record = test::record_under(test::with_effect<model::CommandDelay>({kDelay}), [](double t) {
    return 1e-2 * std::sin(2.0 * std::numbers::pi * t) + 2e-2 * std::sin(2.0 * std::numbers::pi * 40.0 * t);
  });
  const Screened delay = screened_alone("command_delay", record);
  DOUBLES_EQUAL(kDelay, delay.fitted.free.back().value(delay.fitted.u.back()), 1e-3);
}
