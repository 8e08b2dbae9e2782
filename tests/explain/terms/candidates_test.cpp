// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/candidates.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <set>
#include <string>

#include "tools/explain/terms/unlisted.hpp"

namespace {

using namespace hotfire::explain;

Dataset every_channel() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, true, true};
  return data;
}

}  // namespace

TEST_GROUP(Candidates){};

TEST(Candidates, AParameterIsAddressedByItsEffectAndFieldAndItsKeyIsThatOfModelFiles) {
  const hotfire::SimplexParameters neutral;
  std::size_t parameters = 0;
  for (const Candidate& candidate : all_candidates(neutral, every_channel())) {
    std::set<Address> addresses;
    for (const FreeParameter& free : effect_parameters(neutral, candidate, {})) {
      CHECK_TRUE_TEXT(addresses.insert(free.address).second, free.key.c_str());
      CHECK_TRUE(free.is_of_effect(candidate.effect) && !free.is_of_effect(candidate.effect + 1));
      STRCMP_EQUAL(("effects." + candidate.name + "." + std::string(free.address.field)).c_str(), free.key.c_str());
      ++parameters;
    }
  }
  CHECK_TRUE(parameters > 40);
}

TEST(Candidates, APointOfATableIsAddressedByItsNumberToo) {
  ModelParameters parameters = hotfire::SimplexParameters();
  for (const Candidate& candidate : unlisted_candidates(parameters, every_channel())) {
    if (candidate.name != "unlisted_flow" || candidate.option_name != "opening") {
      continue;
    }
    activate(parameters, candidate);
    visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
      if constexpr (std::is_same_v<E, hotfire::model::UnlistedFlow>) {
        CHECK_EQUAL(candidate.effect, index);
        values.table.points = 3;
        values.table.x = {-1.0, 0.0, 1.0};
      }
    });
    const std::vector<FreeParameter> free = effect_parameters(parameters, candidate, {});
    CHECK_EQUAL(3U, free.size());
    STRCMP_EQUAL("effects.unlisted_flow.flow_at_opening.2", free[2].key.c_str());
    CHECK_TRUE(free[2].is_ordinate() && free[2].address.point == 2 && free[2].index == free[1].index + 1);
    CHECK_FALSE(free[2].is_same_as(free[1]));
    return;
  }
  FAIL("there is no such candidate");
}

// Friction in two directions is small only where both of its levels are, and its viscous parts.
TEST(Candidates, AnEffectOfSeveralPartsHasOneStartAtWhichAllOfThemAreSmall) {
  const ModelParameters neutral = hotfire::DirectParameters{};
  for (const Candidate& candidate : all_candidates(neutral, every_channel())) {
    if (candidate.name != "sliding_friction" || candidate.option != 0) {
      continue;
    }
    const std::vector<FreeParameter> own = effect_parameters(neutral, candidate, {});
    CHECK_TRUE(own.size() > 1);
    const auto is_small = [&](const std::vector<double>& start) {
      std::size_t small = 0;
      for (std::size_t k = 0; k < own.size(); ++k) {
        small += own[k].value(start[k]) < 0.1 * own[k].unit_size ? 1 : 0;
      }
      return small == own.size();
    };
    CHECK_EQUAL(1, std::ranges::count_if(start_points(own, {}), is_small));
    return;
  }
  FAIL("no sliding_friction among the candidates");
}

TEST(Candidates, APositiveParameterAloneStartsOnACombFromASixteenthToSixteenTimesItsTypicalValue) {
  const hotfire::SimplexParameters neutral;
  for (const Candidate& candidate : all_candidates(neutral, every_channel())) {
    if (candidate.name != "rate_limit") {
      continue;
    }
    const std::vector<FreeParameter> own = effect_parameters(neutral, candidate, {});
    CHECK_EQUAL(1U, own.size());
    const std::vector<std::vector<double>> starts = start_points(own, {});
    const auto value = [&](std::size_t i) { return own.front().value(starts[i].front()) / own.front().unit_size; };
    DOUBLES_EQUAL(1.0 / 16.0, value(0), 1e-12);
    DOUBLES_EQUAL(16.0, value(starts.size() - 1), 1e-9);
    for (std::size_t i = 1; i < starts.size(); ++i) {
      // A valley between a limit that does nothing and one that overshoots is about a factor of two wide.
      CHECK_TRUE(value(i) > value(i - 1) && value(i) < 2.0 * value(i - 1));
    }
    return;
  }
  FAIL("no rate_limit among the candidates");
}
