// SPDX-License-Identifier: Apache-2.0
#include "tools/study/draws/wild_draw.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace hotfire::study {
namespace {

/// Rows of sines: every quantity, and every product of two, has a scale.
QuantityRows some_rows() {
  QuantityRows rows;
  for (int i = 0; i < 2000; ++i) {
    WildQuantities row{};
    for (std::size_t a = 0; a < kWildArguments; ++a) {
      row[a] = std::pow(10.0, static_cast<double>(a) - 6.0) * std::sin(0.37 * i * (1.0 + 0.1 * static_cast<double>(a)));
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<WildLaw> some_laws(std::uint64_t count) {
  const WildScales scales(some_rows());
  std::vector<WildLaw> laws;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    Random random("laws of a test", seed);
    laws.push_back(draw_wild_law(random, {}, scales));
  }
  return laws;
}

}  // namespace

TEST_GROUP(WildDraws){};

// 99 of 100 rows of a sine of one are below sin(0.99 pi / 2) = 0.99988.
TEST(WildDraws, AScaleIsHalfOfWhatNearlyAllRowsStayBelow) {
  const WildScales scales(some_rows());
  for (std::size_t a = 0; a < kWildArguments; ++a) {
    DOUBLES_EQUAL(0.5, scales.of(static_cast<WildArgument>(a)) / std::pow(10.0, static_cast<double>(a) - 6.0), 1e-3);
  }
  // Of the square of a sine the same row is the largest.
  DOUBLES_EQUAL(0.5, scales.of(WildArgument::position, WildArgument::position) / 1e-12, 1e-3);
}

TEST(WildDraws, NoneIsAListedEffectAndEverySiteHasItsShare) {
  std::array<int, kWildSites> drawn{};
  for (const WildLaw& law : some_laws(500)) {
    CHECK_FALSE(is_known_effect(law));
    CHECK_TRUE(std::abs(law.amplitude) > 0.0);
    ++drawn[static_cast<std::size_t>(law.site)];
  }
  // 50 each; five standard deviations of a share of a tenth in 500 are 34.
  for (const int count : drawn) {
    CHECK_TRUE(count > 16 && count < 84);
  }
}

// Every memory, shape and quantity comes up: with 500 laws the rarest, one in 60 or so, is left out once in 4,000 runs.
TEST(WildDraws, EveryMemoryShapeAndQuantityIsDrawn) {
  std::set<WildMemory::Kind> memories;
  std::set<WildCurve::Shape> shapes;
  std::set<WildArgument> arguments;
  int replacing = 0;
  int products = 0;
  for (const WildLaw& law : some_laws(500)) {
    memories.insert(law.memory.kind);
    shapes.insert(law.curve.shape);
    arguments.insert(law.argument);
    replacing += law.replaces ? 1 : 0;
    products += law.factor ? 1 : 0;
  }
  UNSIGNED_LONGS_EQUAL(12, memories.size());
  UNSIGNED_LONGS_EQUAL(10, shapes.size());
  UNSIGNED_LONGS_EQUAL(kWildArguments, arguments.size());
  CHECK_TRUE(replacing > 50 && products > 50);
}

TEST(WildDraws, ACurveThatIsAddedIsZeroAtZeroAndOneAtMost) {
  for (const WildLaw& law : some_laws(300)) {
    DOUBLES_EQUAL(0.0, law.curve(0.0), 1e-12);
    if (!law.replaces && law.curve.shape != WildCurve::Shape::line) {
      double largest = 0.0;
      for (int i = -40; i <= 40; ++i) {
        largest = std::max(largest, std::abs(law.curve(0.05 * i)));
      }
      DOUBLES_EQUAL(1.0, largest, 1e-6);
    }
  }
}

TEST(WildDraws, TheSameStreamGivesTheSameLaw) {
  const auto first = some_laws(40);
  const auto again = some_laws(40);
  std::set<std::string> words;
  for (std::size_t i = 0; i < first.size(); ++i) {
    STRCMP_EQUAL(words_of(first[i]).c_str(), words_of(again[i]).c_str());
    DOUBLES_EQUAL(first[i].amplitude, again[i].amplitude, 0.0);
    words.insert(words_of(first[i]));
  }
  CHECK_TRUE(words.size() > 35);
}

// Each beside a neighbour that is no listed effect.
TEST(WildDraws, AListedEffectAndAGainAreKnownAndTheirNeighboursAreNot) {
  const auto law = [](WildSite site, WildArgument argument, WildMemory::Kind kind) {
    WildLaw drawn;
    drawn.site = site;
    drawn.argument = argument;
    drawn.memory.kind = kind;
    if (kind == WildMemory::Kind::plays || kind == WildMemory::Kind::stops) {
      drawn.memory.plays = {{0.1, 1.0}};
    }
    return drawn;
  };
  using Kind = WildMemory::Kind;
  CHECK_TRUE(is_known_effect(law(WildSite::flow, WildArgument::spool, Kind::none)));
  CHECK_TRUE(is_known_effect(law(WildSite::command, WildArgument::command, Kind::delay)));
  CHECK_FALSE(is_known_effect(law(WildSite::command, WildArgument::error, Kind::delay)));
  CHECK_TRUE(is_known_effect(law(WildSite::command, WildArgument::command, Kind::rate_limit)));
  CHECK_FALSE(is_known_effect(law(WildSite::valve, WildArgument::spool, Kind::rate_limit)));
  CHECK_TRUE(is_known_effect(law(WildSite::engine_sensor, WildArgument::angle, Kind::first_order)));
  CHECK_FALSE(is_known_effect(law(WildSite::engine_sensor, WildArgument::angle, Kind::second_order)));
  WildLaw friction = law(WildSite::engine_torque, WildArgument::angle, Kind::stops);
  CHECK_TRUE(is_known_effect(friction));
  friction.memory.plays.push_back({0.3, 1.0});
  CHECK_FALSE(is_known_effect(friction));
  WildLaw play = law(WildSite::valve_command, WildArgument::valve_command, Kind::plays);
  play.replaces = true;
  CHECK_TRUE(is_known_effect(play));
  WildLaw lap = law(WildSite::valve, WildArgument::spool, Kind::none);
  lap.curve = {WildCurve::Shape::dead_zone, 1.0, {{0.1, 0.0, 0.0}}};
  CHECK_TRUE(is_known_effect(lap));
  lap.curve.shape = WildCurve::Shape::stairs;
  CHECK_FALSE(is_known_effect(lap));
}

TEST(WildDraws, AStopOverThePositionOfTheEngineContainsItsFriction) {
  WildLaw law;
  law.site = WildSite::engine_torque;
  law.argument = WildArgument::angle;
  law.memory.kind = WildMemory::Kind::stops;
  law.memory.plays = {{0.1, 0.5}, {0.3, 0.5}};
  STRCMP_EQUAL("gimbal_friction", std::string(contained_effect(law)).c_str());
  law.site = WildSite::flow;
  STRCMP_EQUAL("", std::string(contained_effect(law)).c_str());
}

}  // namespace hotfire::study
