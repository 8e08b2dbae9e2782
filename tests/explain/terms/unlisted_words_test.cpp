// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/unlisted_words.hpp"

#include <set>
#include <string>

#include <CppUTest/TestHarness.h>

#include "model/effects/unlisted/term.hpp"

namespace {

using namespace hotfire;
using explain::Candidate;
using explain::FittedTable;
using model::Argument;
using model::Memory;
using model::term::Order;

FittedTable as_stored() { return {"at", "", "added", "m^3/s", "what is added", {-0.01, 0.0, 0.01}, {-1e-4, 0.0, 3e-4}}; }

Candidate term_of(Memory memory, Argument argument, int factor, Order order) {
  return {
      0, static_cast<int>(memory), "term_flow", "", "flow", {static_cast<int>(argument), factor, static_cast<int>(order)}};
}

FittedTable shown(Memory memory, Argument argument, int factor, Order order) {
  return explain::with_own_axes(as_stored(), term_of(memory, argument, factor, order));
}

}  // namespace

TEST_GROUP(UnlistedWords){};

TEST(UnlistedWords, ACurveOfATermIsOverTheQuantityOfTheTermInItsUnit) {
  const FittedTable table = shown(Memory::resonance, Argument::error, 0, Order::curve_first);
  STRCMP_EQUAL("error", table.x_name.c_str());
  STRCMP_EQUAL("m", table.x_unit.c_str());
  STRCMP_EQUAL("addition to the flow", table.y_name.c_str());
  STRCMP_EQUAL("addition to the flow (through a resonance)", table.meaning.c_str());
  STRCMP_EQUAL("m^3/s", table.y_unit.c_str());
  STRCMP_CONTAINS("addition to the flow (through a resonance) from -0.0001 to 0.0003 m^3/s over error from -0.01 to 0.01 m.",
                  explain::in_words(table).c_str());
}

TEST(UnlistedWords, EveryMemoryHasItsOwnWords) {
  std::set<std::string> words;
  for (std::size_t kind = 0; kind < model::kMemoryNames.size(); ++kind) {
    words.insert(explain::dependence_in_words(term_of(static_cast<Memory>(kind), Argument::error, 0, Order::curve_last)));
  }
  LONGS_EQUAL(model::kMemoryNames.size(), words.size());
}

TEST(UnlistedWords, ACurveBehindAMemoryIsOverTheOutputOfTheMemory) {
  const FittedTable table = shown(Memory::lag, Argument::command, 0, Order::curve_last);
  STRCMP_EQUAL("command (through a first-order lag)", table.x_name.c_str());
  STRCMP_EQUAL("addition to the flow", table.meaning.c_str());
}

TEST(UnlistedWords, TheUnitOfAProductIsThatOfBothFactors) {
  const auto unit = [](Argument argument, Argument factor) {
    return shown(Memory::none, argument, 1 + static_cast<int>(factor), Order::curve_last).x_unit;
  };
  STRCMP_EQUAL("(m/s).(Pa)", unit(Argument::rate, Argument::load_pressure).c_str());
  STRCMP_EQUAL("(m)^2", unit(Argument::position, Argument::position).c_str());
  STRCMP_EQUAL("Pa", unit(Argument::spool, Argument::load_pressure).c_str());
  STRCMP_EQUAL("1", unit(Argument::spool, Argument::spool).c_str());
}

TEST(UnlistedWords, AnOscillatorIsTunedInHertzAndAStopOperatorIsWeighted) {
  STRCMP_EQUAL("Hz", shown(Memory::oscillator, Argument::flow, 0, Order::curve_last).y_unit.c_str());
  const FittedTable stops = shown(Memory::stops, Argument::position, 0, Order::curve_last);
  STRCMP_EQUAL("(m^3/s)/(m)", stops.y_unit.c_str());
  STRCMP_EQUAL("stop width of position", stops.x_name.c_str());
  STRCMP_EQUAL("m^3/s", shown(Memory::stops, Argument::spool, 0, Order::curve_last).y_unit.c_str());
}

TEST(UnlistedWords, OfAQuantityWithoutDimensionNoUnitIsSaid) {
  STRCMP_CONTAINS("over spool from -0.01 to 0.01. Beyond",
                  explain::in_words(shown(Memory::none, Argument::spool, 0, Order::curve_last)).c_str());
}

TEST(UnlistedWords, AnyOtherTableKeepsItsAxes) {
  const FittedTable table = explain::with_own_axes(as_stored(), {0, 0, "unlisted_flow", "opening", "flow"});
  STRCMP_EQUAL("at", table.x_name.c_str());
  STRCMP_EQUAL("what is added", table.meaning.c_str());
}
