// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/common_bias.hpp"

#include <CppUTest/TestHarness.h>

using namespace hotfire::explain;

namespace {

/// Two records of an axis, of which only the zeros are looked at.
Dataset two_records() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  for (int e = 0; e < 2; ++e) {
    Experiment experiment;
    experiment.period = 2e-3;
    experiment.measured = {{0.0}, {0.0}, {}};
    experiment.noise = {8e-6, 6e-5, 1.0};
    experiment.zero_deviation = {2e-3, 3e-3, 0.0};
    data.experiments.push_back(experiment);
  }
  return data;
}

/// Zeros that a bias of 0.02 leaves: the position error bias / K_e of the piston, and the engine at the angle of that stroke
/// less what the duct's stiffness takes of the load spring.
Zeros of_bias(const hotfire::SimplexParameters& parameters, double bias) {
  const double arm = parameters.actuator.moment_arm;
  const double spring = 1.0 / (1.0 / parameters.actuator.stiffness + 1.0 / parameters.structure.stiffness);
  const double follows = spring * arm * arm / (spring * arm * arm + parameters.engine.duct_stiffness);
  const double stroke = bias / parameters.servovalve.position_gain;
  return {{stroke, stroke / arm * follows, 0.0}, {stroke, stroke / arm * follows, 0.0}};
}

}  // namespace

TEST_GROUP(CommonBias){};

// What leaks past the piston under the duct's load takes less than a hundredth of the shift.
TEST(CommonBias, ZerosThatOneValveMakesAreItsBias) {
  const hotfire::SimplexParameters axis;
  const auto bias = common_valve_bias(two_records(), of_bias(axis, 0.02), axis);
  CHECK(bias.has_value());
  DOUBLES_EQUAL(0.02, *bias, 2e-4);
}

TEST(CommonBias, ZerosThatDifferBetweenRecordsOrChannelsAreTheSensors) {
  const hotfire::SimplexParameters axis;
  Zeros zeros = of_bias(axis, 0.02);
  zeros[1][0] *= 0.5;
  CHECK(!common_valve_bias(two_records(), zeros, axis));
  zeros = of_bias(axis, 0.02);
  zeros[0][1] = zeros[1][1] = -zeros[0][1];
  CHECK(!common_valve_bias(two_records(), zeros, axis));
}

TEST(CommonBias, ZerosBelowTheNoiseOfOneReadingAndSingleRecordsIdentifyNone) {
  const hotfire::SimplexParameters axis;
  CHECK(!common_valve_bias(two_records(), of_bias(axis, 1e-4), axis));
  Dataset one = two_records();
  one.experiments.pop_back();
  CHECK(!common_valve_bias(one, {of_bias(axis, 0.02)[0]}, axis));
}
