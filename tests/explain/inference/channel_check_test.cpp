// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/channel_check.hpp"

#include <cmath>
#include <string>

#include "tools/files/text/error.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

/// A record whose engine is `factor` times what the model predicts, a lag of a tenth of a radian included, and its
/// prediction.
std::pair<Dataset, Prediction> engine_at(double factor) {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {false, true, false};
  data.noise = {8e-6, 6e-5, 1.0};
  Experiment experiment;
  experiment.name = "sweep.csv";
  experiment.period = 0.002;
  std::vector<double> measured;
  std::vector<double> predicted;
  for (int i = 0; i < 5000; ++i) {
    experiment.input.push_back(0.0);
    predicted.push_back(0.01 * std::sin(0.02 * i));
    measured.push_back(factor * 0.01 * std::sin(0.02 * i - 0.1));
  }
  experiment.measured = {{}, measured, {}};
  experiment.fitted = {{0, 5000}};
  experiment.noise = data.noise;
  experiment.zero_deviation.assign(data.channels.size(), 0.0);
  data.experiments.push_back(experiment);
  return {data, {{std::vector<double>(5000, 0.0), predicted, std::vector<double>(5000, 0.0)}}};
}

std::string refusal_of(const Dataset& data, const Prediction& prediction) {
  try {
    refuse_impossible_channels(data, prediction);
  } catch (const hotfire::FileError& error) {
    return error.what();
  }
  return {};
}

std::string refusal_of(double factor) {
  const auto [data, prediction] = engine_at(factor);
  return refusal_of(data, prediction);
}

/// The same with a piston that moves as its prediction times `piston`.
std::string refusal_of(double piston, double engine) {
  auto [data, prediction] = engine_at(engine);
  data.used[0] = true;
  prediction[0][0] = prediction[0][1];
  data.experiments[0].measured[0] = prediction[0][0];
  for (double& value : data.experiments[0].measured[0]) {
    value *= piston;
  }
  return refusal_of(data, prediction);
}

}  // namespace

TEST_GROUP(ChannelCheck){};

TEST(ChannelCheck, AChannelThatFollowsItsModelWithLagAndLossIsTaken) {
  STRCMP_EQUAL("", refusal_of(1.0).c_str());
  STRCMP_EQUAL("", refusal_of(0.4).c_str());
}

TEST(ChannelCheck, AChannelThatRunsAgainstItsModelIsRefusedAsInverted) {
  const std::string message = refusal_of(-1.0);
  STRCMP_CONTAINS("sweep.csv: channel engine", message.c_str());
  STRCMP_CONTAINS("inverted", message.c_str());
}

TEST(ChannelCheck, AChannelInAnotherUnitIsRefusedWithTheTwoUnits) {
  STRCMP_CONTAINS("degrees taken for radians", refusal_of(57.3).c_str());
  STRCMP_CONTAINS("radians taken for degrees", refusal_of(1.0 / 57.3).c_str());
  STRCMP_CONTAINS("mis-scaled", refusal_of(7.0).c_str());
}

TEST(ChannelCheck, NoiseIsNotTakenForMotion) { STRCMP_EQUAL("", refusal_of(-0.005).c_str()); }

TEST(ChannelCheck, WhereEveryChannelIsAtFaultAlikeTheCommandIsNamed) {
  STRCMP_CONTAINS("the command looks inverted", refusal_of(-1.0, -1.0).c_str());
  STRCMP_CONTAINS("channel engine runs against", refusal_of(1.0, -1.0).c_str());
  // Channels at 1 / 57.3 of what the command asks for: it stands in degrees.
  const std::string message = refusal_of(1.0 / 57.3, 1.0 / 57.3);
  STRCMP_CONTAINS("the command looks mis-scaled (degrees taken for radians?)", message.c_str());
  STRCMP_CONTAINS("channel piston follows", refusal_of(1.0 / 57.3, 1.0).c_str());
}
