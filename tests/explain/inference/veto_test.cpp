// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/veto.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace hotfire::explain;

namespace {

constexpr double kVetoPeriod = 2e-3;
constexpr std::size_t kVetoRows = 8000;

double sine(double frequency, std::size_t row) {
  return std::sin(2.0 * 3.141592653589793 * frequency * static_cast<double>(row) * kVetoPeriod);
}

/// Two records of a motion at 1 and at 9 Hz with a noise of 1e-3, half of each held out.
Dataset pair_of_records() {
  Dataset data;
  data.channels = {"piston"};
  data.used = {true};
  data.noise = {1e-3};
  data.noise_source = {NoiseSource::declared};
  for (const char* name : {"first.csv", "second.csv"}) {
    Experiment experiment;
    experiment.name = name;
    experiment.period = kVetoPeriod;
    experiment.input.assign(kVetoRows, 0.0);
    experiment.measured.emplace_back();
    for (std::size_t i = 0; i < kVetoRows; ++i) {
      experiment.measured[0].push_back(sine(1.0, i) + 0.2 * sine(9.0, i));
    }
    experiment.noise = data.noise;
    experiment.zero_deviation = {0.0};
    experiment.fitted = {{0, kVetoRows / 2}};
    experiment.held_out = {{kVetoRows / 2, kVetoRows}};
    data.experiments.push_back(std::move(experiment));
  }
  return data;
}

/// A model that is off by sines of 1 Hz and 9 Hz, by record.
Prediction off_by(const Dataset& data, double slow_first, double slow_second, double fast) {
  Prediction prediction(2);
  for (std::size_t e = 0; e < 2; ++e) {
    prediction[e].push_back(data.experiments[e].measured[0]);
    for (std::size_t i = 0; i < kVetoRows; ++i) {
      prediction[e][0][i] += (e == 0 ? slow_first : slow_second) * sine(1.0, i) + fast * sine(9.0, i);
    }
  }
  return prediction;
}

}  // namespace

TEST_GROUP(Veto){};

TEST(Veto, ARecordThatBecomesWorseIsNamedThoughTheWholeIsBetter) {
  const Dataset data = pair_of_records();
  const Prediction calibrated = off_by(data, 0.10, 0.02, 0.0);
  STRCMP_EQUAL("", harm_of(data, off_by(data, 0.05, 0.0205, 0.0), calibrated).c_str());
  STRCMP_CONTAINS("the error in second.csv is 50 % larger",
                  harm_of(data, off_by(data, 0.05, 0.03, 0.0), calibrated).c_str());
}

TEST(Veto, ABandThatBecomesWorseIsNamedThoughEveryRecordIsBetter) {
  const Dataset data = pair_of_records();
  const Prediction calibrated = off_by(data, 0.10, 0.10, 0.005);
  STRCMP_EQUAL("", harm_of(data, off_by(data, 0.05, 0.05, 0.009), calibrated).c_str());
  STRCMP_CONTAINS("between 8 and", harm_of(data, off_by(data, 0.05, 0.05, 0.02), calibrated).c_str());
}

TEST(Veto, WhatIsNoMoreThanNoiseIsNoHarm) {
  const Dataset data = pair_of_records();
  STRCMP_EQUAL("", harm_of(data, off_by(data, 1e-3, 1.9e-3, 0.0), off_by(data, 1e-3, 1e-3, 0.0)).c_str());
}
