// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/round.hpp"

#include <CppUTest/TestHarness.h>

#include <optional>
#include <vector>

#include "tests/explain/oscillator.hpp"

namespace {

using namespace hotfire;
using explain::Evaluator;
using explain::Resolution;

/// A round of cubic stiffness beside the declared mass, in a record of a cubic spring with detents.
explain::RoundResult round_of(double detents, std::optional<explain::words::Reason> unless_complete) {
  const ModelFile declared = test::declared_oscillator(97.0);
  const explain::Dataset data = explain::make_dataset(declared, {test::oscillator(400.0, 1e-3, detents)});
  const Evaluator fine(data, Resolution::fine);
  const explain::Scales scales = explain::scales_of(declared.parameters, data);
  const explain::Watch watch;
  const explain::Refiner refiner(data, fine, fine, fine, scales, 1, watch);
  const explain::Assessed calibrated = refiner.ranked(test::start_of(declared, data), explain::kRanking);
  std::vector<explain::Candidate> candidates = explain::all_candidates(declared.parameters, data);
  std::erase_if(candidates, [&](const explain::Candidate& candidate) { return candidate.name != "cubic_stiffness"; });
  const Evaluator rough = refiner.for_screening(calibrated.model);
  const explain::Screening screening(rough, calibrated.model, scales, 1);
  explain::Round round(1, data, refiner, calibrated, screening.run(candidates, "round 1", watch), watch);
  return round.run(unless_complete);
}

}  // namespace

TEST_GROUP(Round){};

TEST(Round, AnEffectThatLeavesOnlyNoiseIsKeptWhereNothingLessIs) {
  const auto found = round_of(0.0, explain::words::Reason::more_than_signal);
  CHECK(found.kept.has_value());
}

// The detents are in no list.
TEST(Round, AnEffectThatExplainsPartOfTheErrorIsKeptOnlyWhereItMay) {
  const auto free = round_of(2.0, std::nullopt);
  CHECK(free.kept.has_value());
  const auto bound = round_of(2.0, explain::words::Reason::more_than_signal);
  CHECK(!bound.kept.has_value());
  STRCMP_EQUAL("dropped", bound.trials.front().decision.c_str());
  STRCMP_CONTAINS("a signal at another site", bound.trials.front().reason.c_str());
}
