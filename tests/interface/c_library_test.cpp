// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/interface/cases.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tools/interface/c/hotfire.h"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

struct Close {
  void operator()(hotfire_model* model) const { hotfire_close(model); }
};
using Model = std::unique_ptr<hotfire_model, Close>;

Model open(const Case& own) {
  hotfire_options options;
  hotfire_default_options(&options);
  options.period = own.period;
  hotfire_model* model = nullptr;
  std::array<char, 512> message{};
  LONGS_EQUAL(HOTFIRE_OK, hotfire_open_text(own.text.c_str(), "own.toml", &options, &model, message.data(), message.size()));
  STRCMP_EQUAL("", message.data());
  return Model(model);
}

std::vector<std::size_t> places_of(hotfire_model* model, hotfire_kind kind, const std::vector<std::string>& names) {
  std::vector<std::size_t> places(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    LONGS_EQUAL(HOTFIRE_OK, hotfire_find(model, kind, names[i].c_str(), &places[i]));
  }
  return places;
}

/// A model with its inputs set for one period after the other.
class Drive {
 public:
  Drive(const Case& own, hotfire_model* model)
      : case_(own), model_(model), places_(places_of(model, HOTFIRE_INPUT, own.inputs)), values_(own.inputs.size()) {}

  void set(std::size_t period) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = case_.driven[i][period];
    }
    hotfire_set(model_, HOTFIRE_INPUT, places_.data(), values_.data(), values_.size());
  }

  /// Starts under the first inputs and steps so many periods, each under its own.
  void run(std::size_t periods) {
    set(0);
    hotfire_start(model_, 0.0);
    for (std::size_t period = 0; period < periods; ++period) {
      set(period);
      hotfire_step(model_);
    }
  }

 private:
  const Case& case_;
  hotfire_model* model_;
  std::vector<std::size_t> places_;
  std::vector<double> values_;
};

std::vector<double> outputs_of(hotfire_model* model) {
  std::vector<double> values(hotfire_count(model, HOTFIRE_OUTPUT));
  for (std::size_t i = 0; i < values.size(); ++i) {
    LONGS_EQUAL(HOTFIRE_OK, hotfire_get(model, HOTFIRE_OUTPUT, &i, &values[i], 1));
  }
  return values;
}

void check_same_bits(const std::vector<double>& expected, const std::vector<double>& actual) {
  LONGS_EQUAL(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    MEMCMP_EQUAL(&expected[i], &actual[i], sizeof expected[i]);
  }
}

/// The derivative of every output of the next period by one seed, by central differences of width 2 `width`.
std::vector<double> differences(hotfire_model* model, hotfire_kind kind, std::size_t index, double width) {
  std::vector<char> before(hotfire_state_size(model));
  LONGS_EQUAL(HOTFIRE_OK, hotfire_save(model, before.data(), before.size()));
  double value = 0.0;
  hotfire_get(model, kind, &index, &value, 1);
  std::vector<double> slopes(hotfire_count(model, HOTFIRE_OUTPUT));
  for (const double side : {1.0, -1.0}) {
    const double moved = value + side * width;
    LONGS_EQUAL(HOTFIRE_OK, hotfire_set(model, kind, &index, &moved, 1));
    LONGS_EQUAL(HOTFIRE_OK, hotfire_step(model));
    const std::vector<double> readings = outputs_of(model);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      slopes[i] += side * readings[i] / (2.0 * width);
    }
    LONGS_EQUAL(HOTFIRE_OK, hotfire_load(model, before.data(), before.size()));
  }
  return slopes;
}

}  // namespace

TEST_GROUP(CLibrary){};

TEST(CLibrary, GivesTheBitsOfHotfireSimulateForEveryTopology) {
  for (const Case& own : cases(600)) {
    const Model model = open(own);
    STRCMP_EQUAL(own.topology.c_str(), hotfire_topology(model.get()));
    const std::vector<std::size_t> outputs = places_of(model.get(), HOTFIRE_OUTPUT, own.outputs());
    LONGS_EQUAL(hotfire_count(model.get(), HOTFIRE_OUTPUT), outputs.size());
    Drive drive(own, model.get());
    drive.set(0);
    LONGS_EQUAL(HOTFIRE_OK, hotfire_start(model.get(), 0.0));
    for (std::size_t period = 0; period < own.periods(); ++period) {
      if (own.reads_at(period)) {
        std::vector<double> readings(outputs.size());
        hotfire_get(model.get(), HOTFIRE_OUTPUT, outputs.data(), readings.data(), outputs.size());
        check_same_bits(own.readings_at(period), readings);
      }
      drive.set(period);
      LONGS_EQUAL(HOTFIRE_OK, hotfire_step(model.get()));
    }
  }
}

TEST(CLibrary, TakesNoMemoryAfterCreation) {
  if (!AllocationGuard::available) {
    return;
  }
  for (const Case& own : cases(50)) {
    const Model model = open(own);
    Drive drive(own, model.get());
    std::vector<char> state(hotfire_state_size(model.get()));
    std::vector<double> sensitivity(hotfire_count(model.get(), HOTFIRE_OUTPUT));
    const hotfire_seed seeds[]{{HOTFIRE_INPUT, 0, 1.0}, {HOTFIRE_PARAMETER, 1, 1.0}};
    const std::size_t first = 0;
    double value = 0.0;
    const AllocationGuard guard;
    drive.set(0);
    hotfire_start(model.get(), 0.0);
    for (std::size_t period = 0; period < 50; ++period) {
      drive.set(period);
      hotfire_step(model.get());
      hotfire_get(model.get(), HOTFIRE_OUTPUT, &first, &value, 1);
    }
    hotfire_differentiate(model.get(), seeds, 2, sensitivity.data(), sensitivity.size());
    hotfire_save(model.get(), state.data(), state.size());
    hotfire_get(model.get(), HOTFIRE_PARAMETER, &first, &value, 1);
    hotfire_set(model.get(), HOTFIRE_PARAMETER, &first, &value, 1);
    hotfire_load(model.get(), state.data(), state.size());
    hotfire_step(model.get());
    value = std::nan("");
    hotfire_set(model.get(), HOTFIRE_INPUT, &first, &value, 1);
    LONGS_EQUAL(0, guard.allocations());
    LONGS_EQUAL(0, guard.releases());
  }
}

TEST(CLibrary, ARestoredStateGoesOnWithTheSameBitsInAnotherInstance) {
  for (const Case& own : cases(120)) {
    const Model one = open(own);
    const Model other = open(own);
    Drive drive_one(own, one.get());
    Drive drive_other(own, other.get());
    drive_one.set(0);
    hotfire_start(one.get(), 0.0);
    std::vector<char> state(hotfire_state_size(one.get()));
    for (std::size_t period = 0; period < 120; ++period) {
      if (period == 60) {
        LONGS_EQUAL(HOTFIRE_OK, hotfire_save(one.get(), state.data(), state.size()));
        LONGS_EQUAL(HOTFIRE_OK, hotfire_load(other.get(), state.data(), state.size()));
      }
      drive_one.set(period);
      LONGS_EQUAL(HOTFIRE_OK, hotfire_step(one.get()));
      if (period >= 60) {
        drive_other.set(period);
        LONGS_EQUAL(HOTFIRE_OK, hotfire_step(other.get()));
        check_same_bits(outputs_of(one.get()), outputs_of(other.get()));
        DOUBLES_EQUAL(hotfire_time(one.get()), hotfire_time(other.get()), 0.0);
      }
    }
  }
}

TEST(CLibrary, ADamagedOrForeignStateIsRefusedAndChangesNothing) {
  const std::vector<Case> all = cases(20);
  const Model model = open(all[0]);
  const Model foreign = open(all[1]);
  hotfire_start(model.get(), 0.0);
  std::vector<char> state(hotfire_state_size(model.get()));
  hotfire_save(model.get(), state.data(), state.size());
  for (std::size_t at = 0; at < state.size(); at += 41) {
    std::vector<char> damaged = state;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_load(model.get(), damaged.data(), damaged.size()));
  }
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_load(model.get(), state.data(), state.size() - 1));
  LONGS_EQUAL(HOTFIRE_BAD_DATA, hotfire_load(foreign.get(), state.data(), state.size()));
  STRCMP_CONTAINS("another model", hotfire_message(foreign.get()));
  LONGS_EQUAL(HOTFIRE_OK, hotfire_load(model.get(), state.data(), state.size()));
}

TEST(CLibrary, DerivativesEqualDifferencesForEveryTopology) {
  for (Case& own : cases(120)) {
    // Noise and steps of a reading have no slope.
    for (const std::string line : {"noise = \"10 um\"\n", "step = \"5 um\"\n", "noise = \"20 um\"\n"}) {
      if (const std::size_t at = own.text.find(line); at != std::string::npos) {
        own.text.erase(at, line.size());
      }
    }
    const Model model = open(own);
    Drive drive(own, model.get());
    drive.run(120);
    double largest = 0.0;
    const auto compare = [&](hotfire_kind kind, std::size_t index, double width) {
      const std::vector<double> expected = differences(model.get(), kind, index, width);
      std::vector<double> slopes(expected.size());
      const hotfire_seed seed{kind, index, 1.0};
      LONGS_EQUAL(HOTFIRE_OK, hotfire_differentiate(model.get(), &seed, 1, slopes.data(), slopes.size()));
      // The difference of two readings has the rounding of both; its curvature goes with the width.
      const std::vector<double> readings = outputs_of(model.get());
      for (std::size_t i = 0; i < slopes.size(); ++i) {
        // A string's reading is a small difference of lengths of metres.
        const double size = std::abs(readings[i]) + (own.outputs()[i].starts_with("string") ? 2.0 : 0.0);
        const double rounding = 20.0 * std::numeric_limits<double>::epsilon() * size / width;
        DOUBLES_EQUAL(expected[i], slopes[i], 2e-3 * std::abs(expected[i]) + rounding);
        largest = std::max(largest, std::abs(slopes[i]));
      }
    };
    compare(HOTFIRE_INPUT, 0, 1e-5);
    hotfire_variable variable{};
    for (std::size_t i = 0; i < hotfire_count(model.get(), HOTFIRE_PARAMETER); ++i) {
      hotfire_describe(model.get(), HOTFIRE_PARAMETER, i, &variable);
      const std::string name = variable.name;
      if (name.ends_with("engine.inertia") || name.ends_with("servovalve.position_gain") || name == "mass.stiffness") {
        compare(HOTFIRE_PARAMETER, i, 1e-4 * variable.start);
      }
    }
    CHECK(largest > 1e-9);
  }
}

TEST(CLibrary, SeedsAddUpAndLeaveTheModelAsItIs) {
  const std::vector<Case> all = cases(20);
  const Model model = open(all[0]);
  hotfire_start(model.get(), 0.0);
  const std::vector<double> before = outputs_of(model.get());
  std::array<double, 3> one{};
  std::array<double, 3> other{};
  std::array<double, 3> both{};
  const hotfire_seed seeds[]{{HOTFIRE_INPUT, 0, 2.0}, {HOTFIRE_PARAMETER, 3, -0.5}};
  hotfire_differentiate(model.get(), &seeds[0], 1, one.data(), 3);
  hotfire_differentiate(model.get(), &seeds[1], 1, other.data(), 3);
  hotfire_differentiate(model.get(), seeds, 2, both.data(), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    DOUBLES_EQUAL(one[i] + other[i], both[i], 1e-12 * (std::abs(one[i]) + std::abs(other[i])));
  }
  CHECK(std::abs(one[0]) > 0.0);
  check_same_bits(before, outputs_of(model.get()));
}

TEST(CLibrary, ATunableParameterChangesTheRunAsADeclaredOneDoes) {
  const Case own = cases(200)[0];
  Case declared = own;
  declared.text += "[engine]\ninertia = 8000.0\n";
  const Model tuned = open(own);
  const Model from_file = open(declared);
  std::size_t inertia = 0;
  hotfire_find(tuned.get(), HOTFIRE_PARAMETER, "engine.inertia", &inertia);
  const double value = 8000.0;
  hotfire_start(tuned.get(), 0.0);
  hotfire_start(from_file.get(), 0.0);
  LONGS_EQUAL(HOTFIRE_OK, hotfire_set(tuned.get(), HOTFIRE_PARAMETER, &inertia, &value, 1));
  Drive drive_tuned(own, tuned.get());
  Drive drive_from_file(own, from_file.get());
  for (std::size_t period = 0; period < 200; ++period) {
    drive_tuned.set(period);
    drive_from_file.set(period);
    hotfire_step(tuned.get());
    hotfire_step(from_file.get());
  }
  check_same_bits(outputs_of(from_file.get()), outputs_of(tuned.get()));
}

TEST(CLibrary, InstancesInThreadsDoNotDisturbEachOther) {
  const std::vector<Case> all = cases(150);
  std::vector<std::vector<double>> ends(2 * all.size());
  const auto run = [&](std::size_t i) {
    const Case& own = all[i % all.size()];
    hotfire_options options;
    hotfire_default_options(&options);
    options.period = own.period;
    hotfire_model* plain = nullptr;
    hotfire_open_text(own.text.c_str(), "own.toml", &options, &plain, nullptr, 0);
    const Model model(plain);
    Drive drive(own, model.get());
    drive.run(149);
    ends[i].resize(hotfire_count(model.get(), HOTFIRE_OUTPUT));
    for (std::size_t k = 0; k < ends[i].size(); ++k) {
      hotfire_get(model.get(), HOTFIRE_OUTPUT, &k, &ends[i][k], 1);
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    threads.emplace_back(run, i);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(!ends[i].empty());
    check_same_bits(ends[i], ends[i + all.size()]);
  }
}

}  // namespace hotfire::test
