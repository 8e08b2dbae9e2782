// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/rivals.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/explain/oscillator.hpp"

namespace {

using namespace hotfire;
using explain::Evaluator;
using explain::Resolution;

/// A mass on a spring of cubic stiffness, or of none, that two laws were fitted to.
struct TwoLaws {
  explicit TwoLaws(double cubic)
      : declared(test::declared_oscillator(97.0)), data(explain::make_dataset(declared, {test::oscillator(cubic, 1e-3)})) {
    result.calibrated = refiner.ranked(test::start_of(declared, data), explain::kRanking);
  }

  explain::Candidate candidate(const std::string& name) const {
    for (const explain::Candidate& other : explain::all_candidates(declared.parameters, data)) {
      if (other.name == name) {
        return other;
      }
    }
    return {};
  }

  explain::Assessed with(const explain::Candidate& effect) const {
    explain::Fitted start = result.calibrated.model;
    explain::activate(start.base, effect);
    for (const explain::FreeParameter& parameter : explain::effect_parameters(start.base, effect, scales)) {
      start.free.push_back(parameter);
      start.u.push_back(parameter.coordinate(parameter.unit_size));
    }
    return refiner.settled(start);
  }

  /// Keeps one effect, whose rival is the other, and compares the two as if another effect had been found.
  void compare(const std::string& kept, const std::string& other) {
    result.explained = with(candidate(kept));
    result.kept.push_back({{1, candidate(kept), true, 0.0, 1.0, 0.0, "kept", ""}, {}});
    result.trials.push_back(result.kept.back().trial);
    result.rival = explain::Rival{candidate(kept), candidate(other), with(candidate(other)).model};
    rivals.set_aside();
    CHECK(!result.rival);
    rivals.compare_again();
  }

  ModelFile declared;
  explain::Dataset data;
  Evaluator fine{data, Resolution::fine};
  explain::Scales scales = explain::scales_of(declared.parameters, data);
  explain::Watch watch;
  explain::Refiner refiner{data, fine, fine, fine, scales, 1, watch};
  explain::SearchResult result;
  explain::Rivals rivals{refiner, watch, result};
};

}  // namespace

TEST_GROUP(Rivals){};

TEST(Rivals, OneThatExplainsMoreNowTakesThePlaceOfItsEffect) {
  TwoLaws laws(400.0);
  laws.compare("sliding_friction", "cubic_stiffness");
  STRCMP_EQUAL("cubic_stiffness", laws.result.kept[0].trial.candidate.name.c_str());
  STRCMP_EQUAL("kept", laws.result.trials.back().decision.c_str());
  CHECK(!laws.result.rival);
}

TEST(Rivals, OneThatExplainsLessNowIsSeparated) {
  TwoLaws laws(400.0);
  laws.compare("cubic_stiffness", "sliding_friction");
  STRCMP_EQUAL("cubic_stiffness", laws.result.kept[0].trial.candidate.name.c_str());
  STRCMP_EQUAL("dropped", laws.result.trials.back().decision.c_str());
  CHECK(!laws.result.rival);
}

// Neither law explains anything of a linear spring.
TEST(Rivals, OneThatIsStillAsGoodStaysTheRival) {
  TwoLaws laws(0.0);
  laws.compare("cubic_stiffness", "quadratic_stiffness");
  STRCMP_EQUAL("tied", laws.result.trials.back().decision.c_str());
  CHECK(laws.result.rival.has_value());
}

// The names of a search were replaced by a term.
TEST(Rivals, OneWhoseEffectIsNotKeptAnyLongerIsNotCompared) {
  TwoLaws laws(400.0);
  laws.result.rival = explain::Rival{laws.candidate("sliding_friction"), laws.candidate("cubic_stiffness"), {}};
  laws.rivals.set_aside();
  laws.rivals.compare_again();
  CHECK(laws.result.trials.empty());
  CHECK(!laws.result.rival);
}
