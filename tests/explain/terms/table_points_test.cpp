// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/table_points.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>

#include "tests/explain/oscillator.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Fitted;

explain::Candidate force_over_position(const Dataset& data) {
  const auto candidates = explain::unlisted_candidates(DirectParameters(), data);
  return *std::ranges::find_if(candidates, [](const explain::Candidate& candidate) {
    return candidate.name == "unlisted_force" && candidate.option_name == "position";
  });
}

/// The oscillator with a force over its position that zigzags, laid over the rows that `data` has a fit see.
Fitted with_zigzag(const ModelFile& model, const Dataset& data, const explain::Candidate& candidate) {
  Fitted fitted;
  fitted.base = model.parameters;
  const Fitted plain = fitted;
  explain::activate(fitted.base, candidate);
  explain::lay_table(fitted.base, candidate, data, plain);
  fitted.free = explain::effect_parameters(fitted.base, candidate, explain::scales_of(model.parameters, data));
  for (std::size_t k = 0; k < fitted.free.size(); ++k) {
    fitted.u.push_back(k % 2 == 0 ? 0.5 : -1.0 - static_cast<double>(k));
  }
  return fitted;
}

/// The table as the plant runs it.
explain::FittedTable table_of(const Fitted& fitted, const explain::Candidate& candidate) {
  return *explain::table_of(fitted.parameters(), candidate);
}

model::UnlistedTable<double> runnable(const explain::FittedTable& table) {
  model::UnlistedTable<double> result;
  result.points = static_cast<int>(table.x.size());
  std::ranges::copy(table.x, result.x.begin());
  std::ranges::copy(table.y, result.y.begin());
  return result;
}

}  // namespace

TEST_GROUP(table_points){};

TEST(table_points, over_further_rows_a_table_reaches_further_and_is_the_same_function) {
  const ModelFile model = test::declared_oscillator(100.0);
  const Dataset all = explain::make_dataset(model, {test::oscillator(0.0, 1e-3)});
  Dataset few = all;
  few.experiments[0].fitted = {{0, 150}};
  Dataset every_row = all;
  explain::fit_every_row(every_row);
  const explain::Candidate candidate = force_over_position(all);
  const Fitted narrow = with_zigzag(model, few, candidate);
  const Fitted wide = explain::reaching_over(every_row, narrow, candidate);
  const explain::FittedTable before = table_of(narrow, candidate);
  const explain::FittedTable after = table_of(wide, candidate);
  CHECK(after.x.front() < before.x.front());
  CHECK(after.x.back() > before.x.back());
  CHECK(std::ranges::is_sorted(after.x));
  for (int i = 0; i <= 1000; ++i) {
    const double x = after.x.front() + (after.x.back() - after.x.front()) * i / 1000.0;
    DOUBLES_EQUAL(model::unlisted::value_at(runnable(before), x), model::unlisted::value_at(runnable(after), x), 1e-9);
  }
}

TEST(table_points, a_table_that_reaches_over_every_row_stays_as_it_is) {
  const ModelFile model = test::declared_oscillator(100.0);
  Dataset data = explain::make_dataset(model, {test::oscillator(0.0, 1e-3)});
  explain::fit_every_row(data);
  const explain::Candidate candidate = force_over_position(data);
  Fitted fitted = with_zigzag(model, data, candidate);
  // Without a force the mass runs through just the rows that the table was laid over.
  std::ranges::fill(fitted.u, 0.0);
  const Fitted wide = explain::reaching_over(data, fitted, candidate);
  const explain::FittedTable before = table_of(fitted, candidate);
  const explain::FittedTable after = table_of(wide, candidate);
  CHECK_EQUAL(before.x.size(), after.x.size());
  for (std::size_t i = 0; i < before.x.size(); ++i) {
    DOUBLES_EQUAL(before.x[i], after.x[i], 1e-12);
    DOUBLES_EQUAL(before.y[i], after.y[i], 1e-12);
  }
}

namespace {

/// A curve against the motion: of the mass over its rate, of the engine as a term of the grammar over the engine's rate or
/// angle.
bool mass_feeds_energy(double at_negative, double at_rest, double at_positive) {
  DirectParameters parameters;
  using Force = model::UnlistedMotion<model::Site::mass_force>;
  const std::size_t place = test::add_effect<Force>(parameters, [&](auto& effect) {
    effect.option = 1;
    effect.table.points = 3;
    effect.table.x = {-0.1, 0.0, 0.1};
    effect.table.y = {at_negative, at_rest, at_positive};
  });
  return explain::feeds_energy(parameters,
                               {place, 1, std::string(Force::name), "rate", std::string(model::site_name(Force::site))});
}

bool term_feeds_energy(model::Argument argument, double slope) {
  SimplexParameters parameters;
  using Torque = model::Term<model::Site::engine_torque>;
  const std::size_t place = test::add_effect<Torque>(parameters, [&](auto& effect) {
    effect.argument = static_cast<int>(argument);
    effect.table.points = 3;
    effect.table.x = {-0.1, 0.0, 0.1};
    effect.table.y = {-0.1 * slope, 0.0, 0.1 * slope};
  });
  return explain::feeds_energy(parameters, {place,
                                            0,
                                            std::string(Torque::name),
                                            "",
                                            std::string(model::site_name(Torque::site)),
                                            {static_cast<int>(argument), 0, 0}});
}

}  // namespace

TEST(table_points, a_force_that_pushes_with_the_motion_feeds_energy_and_a_constant_one_does_not) {
  CHECK_FALSE(mass_feeds_energy(-2.0, 0.0, 2.0));
  CHECK_FALSE(mass_feeds_energy(3.0, 5.0, 7.0));
  CHECK(mass_feeds_energy(2.0, 0.0, -2.0));
  CHECK(mass_feeds_energy(7.0, 5.0, 3.0));
  // Within a table's scatter, and beyond it.
  CHECK_FALSE(mass_feeds_energy(0.05, 0.0, 2.0));
  CHECK(mass_feeds_energy(0.2, 0.0, 2.0));
}

TEST(table_points, a_power_of_the_rate_is_held_to_the_same_also_beyond_the_records) {
  const auto feeds_energy = [](model::Memory kind, double gain, double direct) {
    SimplexParameters parameters;
    using Torque = model::Term<model::Site::engine_torque>;
    const std::size_t place = test::add_effect<Torque>(parameters, [&](auto& effect) {
      effect.option = static_cast<int>(kind);
      effect.argument = static_cast<int>(model::Argument::angle_rate);
      effect.gain = gain;
      effect.direct = direct;
      effect.width = 0.1;
    });
    return explain::feeds_energy(parameters, {place,
                                              static_cast<int>(kind),
                                              std::string(Torque::name),
                                              "",
                                              std::string(model::site_name(Torque::site)),
                                              {static_cast<int>(model::Argument::angle_rate), 0, 0}});
  };
  CHECK_FALSE(feeds_energy(model::Memory::odd_power, 1e4, 0.0));
  CHECK_TRUE(feeds_energy(model::Memory::odd_power, -1e4, 0.0));
  CHECK_TRUE(feeds_energy(model::Memory::even_power, 1e4, 0.0));
  // It brakes up to the width and drives beyond.
  CHECK_TRUE(feeds_energy(model::Memory::odd_power, -1e4, 1e4));
}

TEST(table_points, a_term_over_the_rate_at_its_site_is_held_to_the_same_and_one_over_the_angle_is_a_spring) {
  CHECK_FALSE(term_feeds_energy(model::Argument::angle_rate, 1e4));
  CHECK(term_feeds_energy(model::Argument::angle_rate, -1e4));
  CHECK_FALSE(term_feeds_energy(model::Argument::angle, -1e4));
}
