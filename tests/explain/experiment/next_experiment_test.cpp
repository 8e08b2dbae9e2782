// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/experiment/next_experiment.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/lab/lab_image.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/simulate/simulate.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;
using explain::CommandLimits;
using explain::Dataset;
using explain::Fitted;

constexpr double kLargest = 0.02;
constexpr double kNoise = 8e-6;

Dataset records() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, false, false};
  data.noise = {kNoise, 6e-5, 1.0};
  explain::Experiment experiment;
  experiment.period = 0.004;
  experiment.input = {0.0, kLargest, -0.5 * kLargest};
  experiment.noise = data.noise;
  experiment.zero_deviation.assign(data.channels.size(), 0.0);
  data.experiments.push_back(experiment);
  return data;
}

/// The reference axis with a dead band of its valve; none at zero.
Fitted with_deadband(double half_width) {
  Fitted fitted;
  explain::visit_effects(fitted.base, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (std::is_same_v<E, model::ValveDeadband>) {
      values.half_width = half_width;
      explain::set_active(fitted.base, index, half_width > 0.0);
    }
  });
  return fitted;
}

}  // namespace

TEST_GROUP(NextExperiment){};

TEST(NextExperiment, FindsNothingBetweenAModelAndItself) {
  const auto next = explain::best_separation(records(), with_deadband(0.02), with_deadband(0.02), limits_of(records()), 2);
  DOUBLES_EQUAL(0.0, next.separation, 0.0);
}

TEST(NextExperiment, StaysWithinTheLargestCommandAndSeparatesAsItSays) {
  const auto next = explain::best_separation(records(), with_deadband(0.0), with_deadband(0.02), limits_of(records()), 2);
  const std::vector<double>& command = next.command.find("command")->values;
  for (const double value : command) {
    CHECK(std::abs(value) <= kLargest * (1.0 + 1e-12));
  }
  // The command it hands out, run through both models by `simulate`, shows the difference it promises.
  double square = 0.0;
  ModelFile one;
  one.parameters = with_deadband(0.0).base;
  ModelFile other;
  other.parameters = with_deadband(0.02).base;
  const Record a = simulate(one, next.command);
  const Record b = simulate(other, next.command);
  for (std::size_t row = 0; row < a.rows; ++row) {
    square += std::pow((a.find("piston")->values[row] - b.find("piston")->values[row]) / kNoise, 2);
  }
  DOUBLES_EQUAL(std::sqrt(square / static_cast<double>(a.rows)), next.separation, 1e-9 * next.separation);
  // A dead band of 2 % of the valve's opening holds the piston back by 2 % over the position gain, 0.23 mm: 29 times the
  // noise. Half of that has to show.
  CHECK(next.separation > 14.0);
}

TEST(NextExperiment, EveryProfileStaysWithinTheRigsLimitsOfPositionAndRate) {
  const CommandLimits limits{-0.01, 0.03, 0.5};
  constexpr double kPeriod = 1e-3;
  const auto profiles = explain::test_profiles(limits, 20.0);
  CHECK(!profiles.empty());
  bool has_bias = false;
  for (const auto& profile : profiles) {
    const std::vector<double> commands = profile.commands(kPeriod);
    has_bias = has_bias || profile.bias != 0.0;
    for (std::size_t row = 0; row < commands.size(); ++row) {
      CHECK(commands[row] <= limits.highest * (1.0 + 1e-12));
      CHECK(commands[row] >= limits.lowest * (1.0 + 1e-12));
      if (row > 0) {
        CHECK(std::abs(commands[row] - commands[row - 1]) <= limits.rate * kPeriod * (1.0 + 1e-9));
      }
    }
  }
  CHECK(has_bias);
}

TEST(NextExperiment, ALabRunsEveryProfileAsItsRecordHasIt) {
  test::Scratch files;
  const std::filesystem::path lab = HOTFIRE_LAB_PROFILE;
  constexpr double kPeriod = 1e-3;
  for (const auto& profile : explain::test_profiles({-0.02, 0.02, load_profile(lab).command_rate}, 20.0)) {
    const LabProfile read = load_profile(files.write("next.toml", profile_with_parts(lab, profile.parts)));
    const auto image = firmware::parse_lab_image(read.image, "next.toml", kPeriod);
    STRCMP_EQUAL("", image.error.c_str());
    const std::vector<double> commands = profile.commands(kPeriod);
    DOUBLES_EQUAL(profile.kLeadIn + profile.seconds, image.settings->profile.duration(), 1e-9);
    std::size_t differ = 0;
    for (std::size_t row = 0; row < commands.size(); ++row) {
      const double asked = image.settings->profile.at(static_cast<double>(row) * kPeriod).front();
      differ += std::abs(asked - commands[row]) > 1e-9 ? 1 : 0;
    }
    // At a step the one may come a row after the other, by rounding; there are four at most.
    CHECK(differ <= 4);
  }
}
