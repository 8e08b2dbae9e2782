// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/verdict.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

Assessed leaving(double times_noise) {
  Assessed assessed;
  ChannelFit fit;
  fit.rows = 100.0;
  fit.mean_square = times_noise * times_noise;
  assessed.goodness.held_out = {fit};
  return assessed;
}

Trial tried(const Candidate& candidate) {
  Trial trial;
  trial.round = 1;
  trial.candidate = candidate;
  return trial;
}

std::string sentence_with(const std::vector<Candidate>& kept, const std::vector<double>& step_error = {}) {
  SearchResult found;
  found.declared = leaving(8.0);
  found.calibrated = leaving(4.0);
  found.explained = leaving(1.0);
  found.explained.step_error = step_error;
  for (const Candidate& candidate : kept) {
    found.kept.push_back({tried(candidate), {}});
  }
  return sentence_of(Verdict::explained, found);
}

const Candidate kLeakage{0, 0, "leakage", "laminar", "flow"};
const Candidate kScale{0, 1, "sensor_scale", "engine", "sensor.engine"};

}  // namespace

TEST_GROUP(Verdict){};

TEST(Verdict, AFaultOfTheRecordIsNotSaidOfTheModel) {
  STRCMP_CONTAINS("The declared model is missing leakage (laminar) at flow. With it,", sentence_with({kLeakage}).c_str());
  STRCMP_CONTAINS("The records have a fault: sensor scale (engine) at sensor.engine. With it,",
                  sentence_with({kScale}).c_str());
  STRCMP_CONTAINS(
      "The declared model is missing leakage (laminar) at flow. The records have a fault: sensor scale (engine) at "
      "sensor.engine. With them, the error on held-out data falls from 8.0 to 1.00 times the noise.",
      sentence_with({kScale, kLeakage}).c_str());
}

TEST(Verdict, WhatTheStepsLeaveIsNotSaidOfTheSensorsAlone) {
  CHECK(sentence_with({kLeakage}).ends_with("The rest is close to the limit of the sensors."));
  CHECK(
      sentence_with({kLeakage}, {3.0}).ends_with("The rest is close to the limit of the sensors and of the model's steps."));
}

TEST(Verdict, AnInterruptedSearchNamesWhatPromisedMostByThen) {
  SearchResult found;
  found.interrupted = true;
  found.declared = found.calibrated = found.explained = leaving(4.0);
  Trial screened = tried(kLeakage);
  screened.delta_criterion = -500.0;
  Trial fitted = tried({0, 0, "backlash", "", "load_spring"});
  fitted.refined = true;
  fitted.delta_criterion = -400.0;
  fitted.held_out_ratio = 0.25;
  found.trials = {screened};
  STRCMP_CONTAINS("on held-out data is 4.0 times the noise. In screening, leakage (laminar) at flow ranked first.",
                  sentence_of(Verdict::undecided, found).c_str());
  found.trials = {screened, fitted};
  STRCMP_CONTAINS("Of the candidates fitted before, backlash at load_spring leaves the least: 25 % of that error.",
                  sentence_of(Verdict::undecided, found).c_str());
  found.trials.clear();
  STRCMP_CONTAINS("on held-out data is 4.0 times the noise.", sentence_of(Verdict::undecided, found).c_str());
  CHECK(sentence_of(Verdict::undecided, found).ends_with("the noise."));
}

TEST(Verdict, TimesTheNoiseIsNotSaidWhereAFloorReplacesIt) {
  SearchResult found;
  found.declared = leaving(8.0);
  found.calibrated = leaving(4.0);
  found.explained = leaving(1.0);
  found.kept.push_back({tried(kLeakage), {}});
  const std::string sentence = sentence_of(Verdict::partly_explained, found, false);
  STRCMP_CONTAINS("falls to 12.5 % of the declared model's error", sentence.c_str());
  CHECK(sentence.find("times the noise") == std::string::npos);
}

TEST(Verdict, TermsOverTheTimeOfARecordAreRecognised) {
  CHECK_TRUE(is_of_record_time({0, 4, "unlisted_torque", "friction_along_time", "engine_torque"}));
  CHECK_TRUE(is_of_record_time({0, 0, "unlisted_drift", "piston", "sensor.piston"}));
  CHECK_FALSE(is_of_record_time({0, 0, "unlisted_torque", "friction_along_position", "engine_torque"}));
  CHECK_FALSE(is_of_record_time(kLeakage));
  using enum hotfire::model::Argument;
  const auto term = [](hotfire::model::Argument argument, int factor, hotfire::model::Memory memory = {}) {
    return Candidate{0, static_cast<int>(memory), "term_flow", "", "flow", {static_cast<int>(argument), factor, 0}};
  };
  CHECK_TRUE(is_of_record_time(term(time, 0)));
  CHECK_TRUE(is_of_record_time(term(time, 1 + static_cast<int>(rate))));
  CHECK_TRUE(is_of_record_time(term(rate, 1 + static_cast<int>(time))));
  CHECK_FALSE(is_of_record_time(term(rate, 0)));
  CHECK_FALSE(is_of_record_time(term(time, 0, hotfire::model::Memory::oscillator)));
}
