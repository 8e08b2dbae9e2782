// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/similar.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

#include "model/numerics/step_size.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire::study {
namespace {

Record sine_record() {
  Record record;
  record.name = "sine.csv";
  // One step of the model on either rig: its longest step does not go with the rig's times.
  record.period = model::kLongestStep;
  record.rows = 4000;
  record.channels = {{"command", "rad", std::vector<double>(record.rows)}};
  for (std::size_t i = 0; i < record.rows; ++i) {
    record.channels[0].values[i] = 0.02 * std::sin(2.0 * std::numbers::pi * 2.0 * static_cast<double>(i) * record.period);
  }
  return record;
}

}  // namespace

TEST_GROUP(SimilarRigs){};

TEST(SimilarRigs, AUnitIsScaledByItsParts) {
  const Similarity to{0.1, 0.5, 8.0};
  const double force = 8.0 * 0.01;
  DOUBLES_EQUAL(1.0, factor_of("1", to), 0.0);
  DOUBLES_EQUAL(2.0, factor_of("rad/s", to), 1e-15);
  DOUBLES_EQUAL(1e-3 / 0.5 / 8.0, factor_of("m^3/s/Pa", to), 1e-15);
  DOUBLES_EQUAL(force * 0.1 * 0.5, factor_of("N.m.s/rad", to), 1e-15);
  DOUBLES_EQUAL(force * 0.25 / 0.1 * 0.01, factor_of("kg.m^2", to), 1e-15);
  DOUBLES_EQUAL(1.0 / std::sqrt(force * 0.25 / 0.1), factor_of("kg^-0.5", to), 1e-15);
  DOUBLES_EQUAL(0.01 * 0.5, factor_of("m^2.s", to), 1e-15);
  CHECK_THROWS(std::invalid_argument, factor_of("inch", to));
  CHECK_THROWS(std::invalid_argument, factor_of("", to));
}

// What no size can change: the simulated rows, over their scales, to the rounding of a stiff simulation.
TEST(SimilarRigs, ASimilarRigMakesTheSimilarRecord) {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", 8e-6}};
  const ModelFile small = similar(model, kSmallAndFast);
  DOUBLES_EQUAL(8e-8, small.noise.at("piston"), 1e-20);
  const Record record = sine_record();
  const Record as_made = simulate(model, record);
  const Record other = simulate(small, similar(record, kSmallAndFast));
  DOUBLES_EQUAL(0.1 * record.period, other.period, 1e-18);
  for (const auto& [channel, size] : {std::pair{"piston", 0.015}, std::pair{"engine", 0.02}}) {
    const double factor = std::string(channel) == "piston" ? kSmallAndFast.length : 1.0;
    for (std::size_t i = 0; i < record.rows; ++i) {
      DOUBLES_EQUAL_TEXT(as_made.find(channel)->values[i], other.find(channel)->values[i] / factor, 1e-6 * size, channel);
    }
  }
}

}  // namespace hotfire::study
