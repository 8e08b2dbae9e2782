// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/screening.hpp"

#include <CppUTest/TestHarness.h>

#include <map>
#include <string>

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

}  // namespace

TEST_GROUP(Screening){};

TEST(Screening, WhatTheModelsOwnParametersGainBesideACandidateIsNotTheCandidates) {
  const auto screened = screened_beside_nearly_calibrated();
  CHECK_FALSE(screened.empty());
  for (const Screened& candidate : screened) {
    CHECK_TRUE(candidate.criterion > -explain::policy().strong_evidence);
  }
}
