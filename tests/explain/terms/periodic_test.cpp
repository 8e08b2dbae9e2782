// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/periodic.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "tests/explain/oscillator.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Fitted;

constexpr double kFrequency = 1.7;
constexpr double kPhase = 2.5;

/// The oscillator's record, and the same with a time that begins later.
Dataset two_starts(const ModelFile& model) {
  Record first = test::oscillator(0.0, 1e-3);
  Record second = first;
  second.name = "later.csv";
  second.start = 3.21;
  return explain::make_dataset(model, {first, second});
}

/// A mass under a sinusoid, the clock of each record where `phases` say at its first row.
Fitted under_sinusoid(const ModelFile& model, const Dataset& data, const explain::Candidate& candidate,
                      std::array<double, 2> phases) {
  Fitted fitted;
  fitted.base = model.parameters;
  explain::activate(fitted.base, candidate);
  fitted.free = explain::effect_parameters(fitted.base, candidate, explain::scales_of(model.parameters, data));
  for (const explain::FreeParameter& parameter : fitted.free) {
    fitted.u.push_back(parameter.coordinate(parameter.unit == "Hz" ? kFrequency : 5.0));
  }
  for (const explain::FreeParameter& clock : explain::clocks(data)) {
    const auto e = static_cast<std::size_t>(clock.experiment);
    fitted.free.push_back(clock);
    // Whole turns in it are nobody's business.
    fitted.u.push_back(clock.coordinate((phases[e] / (2.0 * std::numbers::pi) + static_cast<double>(e)) / kFrequency));
  }
  return fitted;
}

explain::Prediction predicted(const Dataset& data, const Fitted& fitted) {
  explain::Prediction prediction;
  CHECK(explain::Evaluator(data, explain::Resolution::fine).predict(fitted.base, fitted.free, fitted.u, 1, prediction));
  return prediction;
}

explain::Candidate sinusoid(const Dataset& data) {
  const auto candidates = explain::unlisted_candidates(DirectParameters(), data);
  return *std::ranges::find_if(candidates, explain::is_periodic);
}

}  // namespace

TEST_GROUP(periodic){};

TEST(periodic, records_that_start_at_one_phase_are_predicted_alike_by_it_and_by_their_clocks) {
  const ModelFile model = test::declared_oscillator(100.0);
  const Dataset data = two_starts(model);
  const explain::Candidate candidate = sinusoid(data);
  const double later = 2.0 * std::numbers::pi * kFrequency * data.experiments[1].start;
  const Fitted own = under_sinusoid(model, data, candidate, {kPhase, kPhase + later});
  const Fitted common = explain::with_common_phase(data, own, candidate);
  CHECK_EQUAL(own.free.size() - 1, common.free.size());
  const explain::Prediction by_clocks = predicted(data, own);
  const explain::Prediction by_phase = predicted(data, common);
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    for (std::size_t row = 0; row < data.experiments[e].rows(); ++row) {
      DOUBLES_EQUAL(by_clocks[e][0][row], by_phase[e][0][row], 1e-9);
    }
  }
}
