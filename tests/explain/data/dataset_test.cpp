// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/dataset.hpp"

#include <cmath>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/support/refusal.hpp"
#include "tools/files/text/error.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using hotfire::test::refusal;

hotfire::Record record(std::vector<hotfire::Channel> channels, double period) {
  hotfire::Record result;
  result.name = "record.csv";
  result.path = result.name;
  result.period = period;
  result.rows = channels.front().values.size();
  result.channels = std::move(channels);
  return result;
}

hotfire::ModelFile axis() {
  hotfire::ModelFile model;
  model.parameters = hotfire::SimplexParameters{};
  model.noise = {{"piston", 8e-6}};
  return model;
}

}  // namespace

TEST_GROUP(Dataset){};

TEST(Dataset, AQuarterOfEveryRecordIsHeldOutAndNeverItsStart) {
  const std::vector<double> values(26001, 0.001);
  const auto data =
      hotfire::explain::make_dataset(axis(), {record({{"command", "rad", values}, {"piston", "m", values}}, 0.002),
                                              record({{"command", "rad", values}, {"piston", "m", values}}, 0.002)});
  for (const auto& experiment : data.experiments) {
    std::size_t held = 0;
    for (const auto& block : experiment.held_out) {
      CHECK(block.first > 0);
      CHECK(block.last <= experiment.rows());
      held += block.last - block.first;
    }
    // 13 blocks of 4 s: three or four of them.
    CHECK(held >= experiment.rows() * 3 / 13 - 1);
    CHECK(held <= experiment.rows() * 4 / 13 + 1);
  }
  // Blocks are shifted from record to record, so that the same profile is not blind to the same part twice.
  CHECK(data.experiments[0].held_out.front().first != data.experiments[1].held_out.front().first);
}

TEST(Dataset, RowsThatTheUserExcludesAreNeitherFittedNorHeldOut) {
  const std::vector<double> values(20000, 0.001);
  const auto data = hotfire::explain::make_dataset(
      axis(), {record({{"command", "rad", values}, {"piston", "m", values}}, 0.002)},
      {hotfire::explain::exclusion_from("record.csv@3.0-11.5"), hotfire::explain::exclusion_from("record.csv@20-21")});
  std::size_t rows = 0;
  for (const auto& block : data.experiments[0].scored()) {
    rows += block.last - block.first;
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{1500, 5750}, {10000, 10500}}) {
      CHECK(block.last <= from || block.first >= to);
    }
  }
  LONGS_EQUAL(20000 - 4250 - 500, rows);
}

TEST(Dataset, AnExclusionThatNamesNoRecordOrNoTimeIsRefusedWithItsForm) {
  for (const char* text : {"record.csv", "record.csv@3", "record.csv@3-2", "record.csv@a-b", "@", "record.csv@1-2x"}) {
    const std::string message = refusal<hotfire::UsageError>([&] { hotfire::explain::exclusion_from(text); });
    STRCMP_CONTAINS("RECORD@FROM-TO", message.c_str());
  }
  const std::string message = refusal<hotfire::UsageError>([] {
    hotfire::explain::require_known_records({{"other.csv", {0.0, 1.0}}}, {"record.csv"});
  });
  STRCMP_CONTAINS("record.csv", message.c_str());
}

TEST(Dataset, WhatIsMissingOrWrongInExcludedRowsIsBridgedAndTheCommandHolds) {
  std::vector<double> command(5000);
  std::vector<double> piston(5000);
  for (std::size_t row = 0; row < command.size(); ++row) {
    command[row] = 1e-6 * static_cast<double>(row);
    piston[row] = 2e-6 * static_cast<double>(row);
  }
  for (std::size_t row = 1000; row < 1500; ++row) {
    command[row] = std::nan("");
    piston[row] = row % 2 == 0 ? std::nan("") : -32768.0;
  }
  const auto data =
      hotfire::explain::make_dataset(axis(), {record({{"command", "rad", command}, {"piston", "m", piston}}, 0.002)},
                                     {hotfire::explain::exclusion_from("record.csv@2.0-3.0")});
  const auto& experiment = data.experiments[0];
  CHECK(experiment.input_is_held);
  for (std::size_t row = 0; row < command.size(); ++row) {
    DOUBLES_EQUAL(2e-6 * static_cast<double>(row), experiment.measured[0][row], 1e-12);
    const std::size_t held = row >= 1000 && row < 1500 ? 999 : row;
    DOUBLES_EQUAL(1e-6 * static_cast<double>(held), experiment.input[row], 1e-15);
  }
}

TEST(Dataset, AMissingValueBesideAnExclusionIsRefusedWithItsTime) {
  std::vector<double> piston(5000, 0.001);
  piston[1500] = std::nan("");
  const std::string message = refusal<hotfire::UsageError>([&] {
    hotfire::explain::make_dataset(
        axis(), {record({{"command", "rad", std::vector<double>(5000, 0.0)}, {"piston", "m", piston}}, 0.002)},
        {hotfire::explain::exclusion_from("record.csv@2.0-3.0")});
  });
  STRCMP_CONTAINS("piston", message.c_str());
  STRCMP_CONTAINS(" 3 s", message.c_str());
}

TEST(Dataset, AnExclusionBesideTheRecordIsRefusedWithWhereTheRecordLies) {
  const std::vector<double> values(5001, 0.001);
  const std::string message = refusal<hotfire::UsageError>([&] {
    hotfire::explain::make_dataset(axis(), {record({{"command", "rad", values}, {"piston", "m", values}}, 0.002)},
                                   {hotfire::explain::exclusion_from("record.csv@900-901")});
  });
  STRCMP_CONTAINS("record.csv@900-901", message.c_str());
  STRCMP_CONTAINS("0 to 10 s", message.c_str());
}

TEST(Dataset, ADeclaredNoiseIsTakenAndAnUndeclaredOneIsEstimated) {
  std::vector<double> wave(5000);
  for (std::size_t i = 0; i < wave.size(); ++i) {
    wave[i] = std::sin(0.01 * static_cast<double>(i)) + (i % 2 == 0 ? 1e-4 : -1e-4);
  }
  const auto data = hotfire::explain::make_dataset(
      axis(), {record({{"command", "rad", wave}, {"piston", "m", wave}, {"engine", "rad", wave}}, 0.002)});
  DOUBLES_EQUAL(8e-6, data.noise[0], 0.0);
  CHECK(data.noise_declared(0));
  CHECK(!data.noise_declared(1));
  // An alternation of +-a has third differences of 8 a: seen as noise of 8 a / sqrt(20) = 1.79 a, up to the median's bias.
  DOUBLES_EQUAL(1.79e-4, data.noise[1], 0.05e-4);
}

TEST(Dataset, ARecordWithoutTheModelsInputIsRefusedByName) {
  const std::string message = refusal([] {
    hotfire::explain::make_dataset(axis(), {record({{"piston", "m", std::vector<double>(100, 0.0)}}, 0.002)});
  });
  STRCMP_CONTAINS("record.csv", message.c_str());
  STRCMP_CONTAINS("command", message.c_str());
}

TEST(Dataset, AFastRecordIsThinnedToEveryKthRowUnderTheMeanOfTheCommandsBetween) {
  std::vector<double> ramp(100001);
  for (std::size_t row = 0; row < ramp.size(); ++row) {
    ramp[row] = 1e-6 * static_cast<double>(row);
  }
  const auto data = hotfire::explain::make_dataset(axis(),
                                                   {record({{"command", "rad", ramp}, {"piston", "m", ramp}}, 2e-4),
                                                    record({{"command", "rad", ramp}, {"piston", "m", ramp}}, 2e-3)},
                                                   {hotfire::explain::exclusion_from("record.csv@3.0-3.5")});
  const auto thin = hotfire::explain::thinned(data, 2e-3);
  const auto& fast = thin.experiments[0];
  DOUBLES_EQUAL(2e-3, fast.period, 1e-15);
  LONGS_EQUAL(10001, fast.rows());
  LONGS_EQUAL(10001, fast.measured[0].size());
  DOUBLES_EQUAL(ramp[70], fast.measured[0][7], 0.0);
  // Ten commands of a ramp, from the 70th on: their mean is four and a half rows later.
  DOUBLES_EQUAL(ramp[70] + 4.5e-6, fast.input[7], 1e-15);
  const auto seconds = [](const hotfire::explain::Experiment& experiment, const auto& blocks) {
    std::size_t rows = 0;
    for (const auto& block : blocks) {
      rows += block.last - block.first;
    }
    return static_cast<double>(rows) * experiment.period;
  };
  // A row more or less at either end of at most thirty blocks.
  DOUBLES_EQUAL(seconds(data.experiments[0], data.experiments[0].fitted), seconds(fast, fast.fitted), 30 * 2e-3);
  DOUBLES_EQUAL(seconds(data.experiments[0], data.experiments[0].held_out), seconds(fast, fast.held_out), 30 * 2e-3);
  DOUBLES_EQUAL(0.5, seconds(fast, fast.excluded), 2e-3);
  // A record that is no faster stays as it is.
  LONGS_EQUAL(data.experiments[1].rows(), thin.experiments[1].rows());
  CHECK(thin.experiments[1].input == data.experiments[1].input);
}

namespace {

/// Four cycles of a slow sine, read with an alternation of +-noise.
std::vector<double> slow_sine(double noise) {
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(0.01 * std::sin(1.2566e-3 * i) + (i % 2 == 0 ? noise : -noise));
  }
  return values;
}

}  // namespace

// An alternation of +-a is seen as a noise of 1.79 a.
TEST(Dataset, ALouderRecordHasANoiseOfItsOwnWhetherOneIsDeclaredOrNot) {
  const auto quiet = slow_sine(4e-6);
  const auto loud = slow_sine(4e-5);
  const auto records = {record({{"command", "rad", quiet}, {"piston", "m", quiet}, {"engine", "rad", quiet}}, 0.002),
                        record({{"command", "rad", quiet}, {"piston", "m", loud}, {"engine", "rad", loud}}, 0.002)};
  const auto data = hotfire::explain::make_dataset(axis(), records);
  DOUBLES_EQUAL(8e-6, data.experiments[0].noise[0], 1e-12);
  DOUBLES_EQUAL(7.2e-5, data.experiments[1].noise[0], 0.1e-5);
  DOUBLES_EQUAL(7.2e-6, data.experiments[0].noise[1], 0.1e-6);
  DOUBLES_EQUAL(7.2e-5, data.experiments[1].noise[1], 0.1e-5);
}

TEST(Dataset, ASmoothChannelHasAFloorAndNoNoiseToBeSaidInTimesOf) {
  const auto smooth = slow_sine(0.0);
  const auto data = hotfire::explain::make_dataset(
      axis(), {record({{"command", "rad", smooth}, {"piston", "m", smooth}, {"engine", "rad", smooth}}, 0.002)});
  CHECK(data.noise_is_known(0));
  CHECK(!data.noise_is_known(1));
  const double motion = 0.01 / std::sqrt(2.0);
  CHECK(data.noise[1] > 0.99e-7 * motion);
  CHECK(data.noise[1] < 1e-6 * motion);
}

TEST(Dataset, AMeasuredTorqueIsAnInputAndAChannelWithoutAPlaceIsNamed) {
  const auto values = slow_sine(1e-5);
  const auto data = hotfire::explain::make_dataset(
      axis(),
      {record({{"command", "rad", values}, {"piston", "m", values}, {"torque", "N.m", values}, {"force", "N", values}},
              0.002)});
  LONGS_EQUAL(values.size(), data.experiments[0].torque.size());
  LONGS_EQUAL(1, data.experiments[0].unused.size());
  STRCMP_EQUAL("force", data.experiments[0].unused[0].c_str());
  const auto thin = hotfire::explain::thinned(data, 4e-3);
  LONGS_EQUAL(values.size() / 2, thin.experiments[0].torque.size());
}

// A step of the command, of which the record begins some time constants later: the slope of its first rows is within the
// noise, and what is left of the motion is many times the noise.
TEST(Dataset, ARecordOfAnAxisThatMovedBeforeItIsComparedWhereTheStartIsForgotten) {
  using hotfire::Record;
  const hotfire::ModelFile model = hotfire::test::declared();
  const Record whole = hotfire::test::record_under(model, [](double t) { return t < 1.0 ? 0.0 : 0.02; });
  const auto cut = [&](std::size_t first) {
    Record record = whole;
    record.rows -= first;
    for (hotfire::Channel& channel : record.channels) {
      channel.values.erase(channel.values.begin(), channel.values.begin() + static_cast<std::ptrdiff_t>(first));
    }
    return record;
  };
  const auto forgets = [&](const Record& record, std::size_t& first_scored) {
    auto data = hotfire::explain::make_dataset(model, {record});
    LONGS_EQUAL(0, data.experiments.front().first_scored);
    std::vector<std::vector<double>> predicted;
    const Record modelled = hotfire::simulate(model, record);
    for (const std::string& channel : data.channels) {
      predicted.push_back(modelled.find(channel)->values);
    }
    const bool any = hotfire::explain::forget_moving_starts(model.parameters, {predicted}, data);
    first_scored = data.experiments.front().first_scored;
    for (const auto& block : data.experiments.front().scored()) {
      CHECK(block.first >= first_scored);
    }
    return any;
  };
  std::size_t first_scored = 0;
  CHECK(forgets(cut(690), first_scored));
  // Two seconds of the reference axis.
  CHECK(first_scored > 900);
  CHECK(first_scored < 1100);
  CHECK(!forgets(cut(0), first_scored));
  LONGS_EQUAL(0, first_scored);
}

// A delay of the command shows nothing in the first rows, however much it leaves half a second later.
TEST(Dataset, WhatAMissingEffectLeavesOfTheFirstMotionIsNoStartInMotion) {
  using hotfire::Record;
  const hotfire::ModelFile declared = hotfire::test::declared();
  const hotfire::ModelFile late = hotfire::test::with_effect<hotfire::model::CommandDelay>({0.02});
  const Record record = hotfire::test::record_under(late, [](double t) { return t < 0.1 ? 0.0 : 0.02; });
  auto data = hotfire::explain::make_dataset(declared, {record});
  std::vector<std::vector<double>> predicted;
  const Record modelled = hotfire::simulate(declared, record);
  for (const std::string& channel : data.channels) {
    predicted.push_back(modelled.find(channel)->values);
  }
  CHECK(!hotfire::explain::forget_moving_starts(declared.parameters, {predicted}, data));
  LONGS_EQUAL(0, data.experiments.front().first_scored);
}
