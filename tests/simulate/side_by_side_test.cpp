// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/batch/side_by_side.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "tests/model/support/plants.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire::test {
namespace {

using Axis = model::Simplex<double>;

constexpr std::size_t kRows = 700;

/// Sines and, from the middle on, a step that saturates the valve.
Record lively_record(double amplitude) {
  Record record;
  record.start = 0.25;
  record.period = 1e-3;
  record.rows = kRows;
  record.channels.push_back({"command", "rad", {}});
  for (std::size_t row = 0; row < kRows; ++row) {
    const double t = 1e-3 * static_cast<double>(row);
    const double step = row > kRows / 2 ? 0.04 : 0.0;
    record.channels.back().values.push_back(amplitude * (std::sin(9.0 * t) + 0.6 * std::sin(40.0 * t)) + step);
  }
  return record;
}

void add_torque(Record& record) {
  record.channels.push_back({"torque", "N.m", {}});
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels.back().values.push_back(3e3 * std::sin(0.03 * static_cast<double>(row)));
  }
}

ModelFile model_of(const SimplexParameters& parameters) {
  ModelFile model;
  model.parameters = parameters;
  return model;
}

/// Models of an axis that differ in gain, inertia and the numbers of effect E: one of them has E without action, one half
/// and the others more of it. Of a delay one is negative.
template <class E>
std::vector<ModelFile> models_with(int option) {
  std::vector<ModelFile> models;
  for (int i = 0; i < kSideBySide; ++i) {
    SimplexParameters parameters = parameters_around<Axis, E>();
    parameters.servovalve.position_gain *= 1.0 + 0.03 * i;
    parameters.engine.inertia *= 1.0 - 0.02 * i;
    auto values = typical<E, double>(option);
    if (i == 5) {
      const auto without_action = neutral<E, double>(option);
      for (const auto& field : E::template Params<double>::fields()) {
        values.*field.member = without_action.*field.member;
      }
    }
    for (const auto& field : E::template Params<double>::fields()) {
      double& value = values.*field.member;
      value = std::clamp(value * (i == 5 ? 1.0 : 0.5 + 0.2 * i), field.lower, field.upper);
      if (i == 3 && E::name == "sensor_delay") {
        value = -value;
      }
    }
    activate<E, Axis>(parameters, values);
    models.push_back(model_of(parameters));
  }
  return models;
}

std::vector<OpenLoopRun> runs_of(const std::vector<ModelFile>& models, const std::vector<Record>& records) {
  std::vector<OpenLoopRun> runs;
  for (std::size_t i = 0; i < models.size(); ++i) {
    runs.push_back({&models[i], &records[i % records.size()]});
  }
  return runs;
}

bool has_same_bits(const Record& one, const Record& other) {
  bool same = one.start == other.start && one.period == other.period && one.rows == other.rows &&
              one.channels.size() == other.channels.size();
  for (std::size_t c = 0; same && c < one.channels.size(); ++c) {
    const Channel& a = one.channels[c];
    const Channel& b = other.channels[c];
    same = a.name == b.name && a.unit == b.unit && a.values.size() == b.values.size() &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(double)) == 0;
  }
  return same;
}

void check_bits(const std::vector<OpenLoopRun>& runs, const std::string& what) {
  const std::vector<RunOutcome> outcomes = simulate_side_by_side(runs);
  LONGS_EQUAL(runs.size(), outcomes.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Record alone = simulate(*runs[i].model, *runs[i].inputs);
    CHECK_FALSE_TEXT(static_cast<bool>(outcomes[i].failure), what.c_str());
    CHECK_TRUE_TEXT(has_same_bits(alone, outcomes[i].record), (what + ", run " + std::to_string(i)).c_str());
  }
}

std::string message_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::vector<std::vector<std::size_t>> sorted_groups(const std::vector<OpenLoopRun>& runs, unsigned threads) {
  auto groups = groups_side_by_side(runs, threads);
  std::sort(groups.begin(), groups.end());
  return groups;
}

}  // namespace

TEST_GROUP(SideBySide){};

TEST(SideBySide, EveryEffectGivesEachRunTheBitsThatItHasAlone) {
  const std::vector<Record> records{lively_record(0.012), lively_record(0.02), lively_record(0.003)};
  int effects = 0;
  for_each_law([&]<class E>(int option) {
    if constexpr (index_in<E>(model::SimplexEffects{}) < model::SimplexEffects::size && !is_unlisted<E>()) {
      const std::vector<ModelFile> models = models_with<E>(option);
      const std::vector<OpenLoopRun> runs = runs_of(models, records);
      LONGS_EQUAL_TEXT(1, groups_side_by_side(runs, 1).size(), label<E>(option).c_str());
      check_bits(runs, label<E>(option));
      ++effects;
    }
  });
  CHECK_TRUE(effects > 30);
}

TEST(SideBySide, ATorqueInTheRecordsActsOnEachRun) {
  std::vector<Record> records{lively_record(0.012), lively_record(0.02), lively_record(0.003)};
  std::for_each(records.begin(), records.end(), add_torque);
  check_bits(runs_of(models_with<model::GimbalFriction>(2), records), "torque");
}

TEST(SideBySide, FewerRunsThanLanesAreTheSame) {
  const std::vector<Record> records{lively_record(0.012)};
  std::vector<ModelFile> models = models_with<model::SoftStiffness>(0);
  models.resize(3);
  check_bits(runs_of(models, records), "three");
}

TEST(SideBySide, ARunThatRunsAwayFailsAloneAndInTheWordsThatItHasAlone) {
  std::vector<ModelFile> models = models_with<model::TorqueOffset>(0);
  // A spring that pulls away from the middle, stiffer than the load's.
  std::get<SimplexParameters>(models[2].parameters).engine.duct_stiffness = -1e9;
  const std::vector<Record> records{lively_record(0.012)};
  const std::vector<OpenLoopRun> runs = runs_of(models, records);
  const std::vector<RunOutcome> outcomes = simulate_side_by_side(runs);
  std::string alone;
  try {
    simulate(models[2], records.front());
  } catch (const FileError& error) {
    alone = error.what();
  }
  CHECK_TRUE(alone.find("runs away") != std::string::npos);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (i == 2) {
      CHECK_TRUE(static_cast<bool>(outcomes[i].failure));
      STRCMP_EQUAL(alone.c_str(), message_of(outcomes[i].failure).c_str());
    } else {
      CHECK_FALSE(static_cast<bool>(outcomes[i].failure));
      CHECK_TRUE(has_same_bits(simulate(models[i], records.front()), outcomes[i].record));
    }
  }
}

TEST(SideBySide, OnlyRunsThatAreAlikeShareAGroup) {
  // Eight of friction, two of soft springs by a table.
  std::vector<ModelFile> models = models_with<model::GimbalFriction>(2);
  const std::vector<ModelFile> tables = models_with<model::SoftStiffness>(2);
  models.insert(models.end(), tables.begin(), tables.begin() + 2);
  std::vector<Record> records(models.size(), lively_record(0.012));
  constexpr std::size_t friction = index_in<model::GimbalFriction>(model::SimplexEffects{});
  constexpr std::size_t soft = index_in<model::SoftStiffness>(model::SimplexEffects{});
  // Another law, another effect, another length, another step, an effect of unknown law.
  std::get<friction>(std::get<SimplexParameters>(models[0].parameters).effects.values).option = 1;
  activate<model::Leakage, Axis>(std::get<SimplexParameters>(models[1].parameters), typical<model::Leakage, double>(0));
  records[2].rows -= 1;
  records[2].channels.front().values.pop_back();
  std::get<SimplexParameters>(models[3].parameters).actuator.piston_mass = 1.0;
  activate<model::UnlistedRipple, Axis>(std::get<SimplexParameters>(models[4].parameters),
                                        typical<model::UnlistedRipple, double>(0));
  // Tables of another length.
  std::get<soft>(std::get<SimplexParameters>(models[9].parameters).effects.values).table.points -= 1;
  const std::vector<std::vector<std::size_t>> expected{{0}, {1}, {2}, {3}, {4}, {5, 6, 7}, {8}, {9}};
  CHECK(sorted_groups(runs_of(models, records), 1) == expected);
  // Another period, a torque, and channels that `simulate` refuses.
  records[5].period = 2e-3;
  add_torque(records[6]);
  records[7].channels.push_back({"position", "m", records[7].channels.front().values});
  records[7].channels.push_back({"velocity", "rad/s", records[7].channels.front().values});
  const std::vector<std::vector<std::size_t>> alone{{0}, {1}, {2}, {3}, {4}, {5}, {6}, {7}, {8}, {9}};
  CHECK(sorted_groups(runs_of(models, records), 1) == alone);
}

TEST(SideBySide, EveryThreadHasAGroup) {
  const std::vector<Record> records{lively_record(0.012)};
  const ModelFile model = model_of({});
  const std::vector<OpenLoopRun> runs(12, OpenLoopRun{&model, &records.front()});
  LONGS_EQUAL(2, groups_side_by_side(runs, 1).size());
  LONGS_EQUAL(2, groups_side_by_side(runs, 2).size());
  LONGS_EQUAL(4, groups_side_by_side(runs, 4).size());
  // Two runs beside each other take longer than one after the other.
  LONGS_EQUAL(12, groups_side_by_side(runs, 8).size());
  // Of four threads, twelve of many runs have their share only.
  const std::vector<Record> short_records{lively_record(0.012), [] {
                                            Record record = lively_record(0.012);
                                            record.rows -= 1;
                                            record.channels.front().values.pop_back();
                                            return record;
                                          }()};
  std::vector<OpenLoopRun> of_two_lengths;
  for (int i = 0; i < 64; ++i) {
    of_two_lengths.push_back({&model, &short_records[i % 2]});
  }
  LONGS_EQUAL(8, groups_side_by_side(of_two_lengths, 4).size());
  std::size_t members = 0;
  for (const auto& group : groups_side_by_side(runs, 4)) {
    members += group.size();
  }
  LONGS_EQUAL(12, members);
}

}  // namespace hotfire::test
