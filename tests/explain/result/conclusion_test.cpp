// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/conclusion.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"

using namespace hotfire;
using namespace hotfire::explain;
using model::Argument;

namespace {

using FlowTerm = model::Term<model::Site::flow>;

/// The term of the model that a rig runs, of a search that found it over `argument` times `factor`, with a curve of two
/// points. None if it is not active.
std::optional<FlowTerm::Params<double>> term_that_runs(Argument argument, std::optional<Argument> factor, bool keep_drift) {
  SearchResult found;
  found.explained.model = test::about_declared();
  const int factor_index = factor ? 1 + static_cast<int>(*factor) : 0;
  const std::size_t place =
      test::add_effect<FlowTerm>(std::get<SimplexParameters>(found.explained.model.base), [&](auto& term) {
        term.argument = static_cast<int>(argument);
        term.factor = factor_index;
        term.table.points = 2;
        term.table.x = {0.0, 100.0};
        term.table.y = {1e-4, 3e-4};
      });
  Trial trial;
  trial.candidate = {place, 0, std::string(FlowTerm::name), "", "flow", {static_cast<int>(argument), factor_index, 0}};
  found.kept.push_back({trial, {}});
  const ModelParameters plant = plant_of(found, keep_drift);
  const auto& effects = std::get<SimplexParameters>(plant).effects;
  return effects.active[place] ? std::optional(std::get<FlowTerm::Params<double>>(effects.values)) : std::nullopt;
}

}  // namespace

TEST_GROUP(Conclusion){};

TEST(Conclusion, ADriftRunsWithItsMeanUnlessItIsKept) {
  const auto mean = term_that_runs(Argument::time, {}, false);
  CHECK(mean.has_value());
  DOUBLES_EQUAL(2e-4, mean->table.y[0], 1e-12);
  DOUBLES_EQUAL(2e-4, mean->table.y[1], 1e-12);
  const auto kept = term_that_runs(Argument::time, {}, true);
  CHECK(kept.has_value());
  DOUBLES_EQUAL(3e-4, kept->table.y[1], 1e-12);
}

TEST(Conclusion, AQuantityThatDriftsHasNoMeanAndRunsOnlyIfItIsKept) {
  CHECK_FALSE(term_that_runs(Argument::time, Argument::rate, false).has_value());
  CHECK_FALSE(term_that_runs(Argument::rate, Argument::time, false).has_value());
  CHECK(term_that_runs(Argument::rate, Argument::time, true).has_value());
}

TEST(Conclusion, ATermOverAnotherQuantityRunsAsItIs) {
  const auto term = term_that_runs(Argument::rate, {}, false);
  CHECK(term.has_value());
  DOUBLES_EQUAL(3e-4, term->table.y[1], 1e-12);
}
