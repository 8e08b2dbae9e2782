// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tools/analysis/angle_calibration.hpp"
#include "tools/analysis/equivalent_stiffness.hpp"
#include "tools/analysis/free_decay.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::analysis {

TEST_GROUP(FreeDecay){};

TEST(FreeDecay, HasTheFrequencyAndDampingItIsMadeWith) {
  std::vector<double> signal;
  for (int k = 0; k < 4000; ++k) {
    const double time = 1e-3 * k;
    signal.push_back(std::exp(-0.02 * 42.0 * time) * std::sin(42.0 * time));
  }
  const auto decay = free_decay(signal, 1e-3, 4.0);
  CHECK_TRUE(decay.has_value());
  DOUBLES_EQUAL(42.0 / (2.0 * std::numbers::pi), decay->frequency, 2e-3);
  DOUBLES_EQUAL(0.02, decay->damping_ratio, 2e-4);
}

TEST(FreeDecay, IsNoneWhereNothingRings) {
  const std::vector<double> still(1000, 1.0);
  CHECK_FALSE(free_decay(still, 1e-3, 1.0).has_value());
}

TEST_GROUP(EquivalentStiffness){};

TEST(EquivalentStiffness, OfALinearSpringIsItsOwn) {
  const SpringCurve linear = [](double x) { return 4e7 * x; };
  DOUBLES_EQUAL(4e7, equivalent_stiffness(linear, 1e4, 4e7), 4e7 * 1e-9);
}

// [SD] eq. 6-7 of f = a x + b x^3 is a + b x_max^2 / 2.
TEST(EquivalentStiffness, OfACubicSpringIsThatOfItsEnergy) {
  const SpringCurve cubic = [](double x) { return 2e7 * x + 1e13 * x * x * x; };
  const double most = 1e-3;
  DOUBLES_EQUAL(2e7 + 0.5 * 1e13 * most * most, equivalent_stiffness(cubic, cubic(most), 1e8), 10.0);
}

// f = a x + b x^3 about x0: f(x0 + u) - f0 = s u + 3 b x0 u^2 + b u^3 with s = a + 3 b x0^2, whose integral is known.
TEST(EquivalentStiffness, AboutABiasIsThatOfTheEnergyOnBothSidesOfIt) {
  const double a = 2e7;
  const double b = 1e13;
  const SpringCurve cubic = [=](double x) { return a * x + b * x * x * x; };
  const double start = 1.5e-3;
  const double bias = cubic(start);
  const double force = 4e4;
  const auto way_to = [&](double target) {
    double low = -1e-2;
    double high = 1e-2;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (cubic(middle) < target ? low : high) = middle;
    }
    return low - start;
  };
  double work = 0.0;
  double squares = 0.0;
  for (const double u : {way_to(bias + force), way_to(bias - force)}) {
    work += (a + 3.0 * b * start * start) * u * u / 2.0 + b * start * u * u * u + b * u * u * u * u / 4.0;
    squares += u * u;
  }
  DOUBLES_EQUAL(2.0 * work / squares, equivalent_stiffness_about(cubic, bias, force, 2e9), 1e-3 * a * 1e-3);
  // A small swing sees the slope at the bias, whatever its sign, and no bias is eq. 7.
  const double slope = a + 3.0 * b * start * start;
  DOUBLES_EQUAL(slope, equivalent_stiffness_about(cubic, bias, 1.0, 2e9), 1e-6 * slope);
  DOUBLES_EQUAL(slope, equivalent_stiffness_about(cubic, -bias, 1.0, 2e9), 1e-6 * slope);
  DOUBLES_EQUAL(equivalent_stiffness(cubic, force, 2e9), equivalent_stiffness_about(cubic, 0.0, force, 2e9), 0.0);
}

TEST(EquivalentStiffness, OfASofterSpringGivesALoadResonanceThatRisesToTheLinearOne) {
  // Soft up to 1 kN, then 1.2e8 N/m.
  const SpringCurve soft = [](double x) { return x < 2e-5 ? 5e7 * x : 1e3 + 1.2e8 * (x - 2e-5); };
  const LoadResonance load{9490.0, 0.7544, 1.2e8, 0.0, 1.2e8};
  const double linear = std::sqrt(0.5 * 1.2e8 * 0.7544 * 0.7544 / 9490.0) / (2.0 * std::numbers::pi);
  double before = load_resonance(load, soft, 0.0);
  DOUBLES_EQUAL(std::sqrt(1.2 * 5.0 / 17.0 * 1e8 * 0.7544 * 0.7544 / 9490.0) / (2.0 * std::numbers::pi), before, 1e-3);
  for (const double amplitude : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const double now = load_resonance(load, soft, amplitude);
    CHECK_TRUE(now > before && now < linear);
    before = now;
  }
  DOUBLES_EQUAL(linear, before, 1e-3 * linear);
}

TEST(EquivalentStiffness, TakenOutOfALoadResonanceIsTheOnePutIntoIt) {
  const LoadResonance load{9490.0, 0.7544, 5.75e7, 4e5, 1.2e8};
  const double actuator = 8e7;
  const double total = in_series(actuator, load.load_stiffness);
  // J (2 pi f)^2 = K_n + K_T R^2, 1 / K_T = 1 / K_act + 1 / K_L.
  DOUBLES_EQUAL(8e7 * 5.75e7 / (8e7 + 5.75e7), total, 1e-9 * total);
  const double frequency = load_frequency(load, total);
  DOUBLES_EQUAL(total, total_stiffness(load, frequency), 1e-12 * total);
  DOUBLES_EQUAL(actuator, beside(load.load_stiffness, total), 1e-9 * actuator);
  CHECK_TRUE(std::isinf(beside(load.load_stiffness, load.load_stiffness)));
}

// The growth of errors that the declarations state, as derivatives.
TEST(EquivalentStiffness, HasTheErrorOfItsFrequencyAsManyTimesAsItSays) {
  const LoadResonance load{9490.0, 0.7544, 5.75e7, 4e5, 1.2e8};
  const double total = in_series(8e7, load.load_stiffness);
  const double off = 1e-6;
  const double in_total = total_stiffness(load, (1.0 + off) * load_frequency(load, total)) / total - 1.0;
  DOUBLES_EQUAL(2.0 * (1.0 + 4e5 / (total * 0.7544 * 0.7544)), in_total / off, 1e-4);
  const double in_actuator = beside(load.load_stiffness, (1.0 + off) * total) / 8e7 - 1.0;
  DOUBLES_EQUAL(1.0 / (1.0 - total / load.load_stiffness), in_actuator / off, 1e-4);
}

TEST_GROUP(AngleCalibration){};

TEST(AngleCalibration, RecoversAnAffineTransformAndWhatItDoesNotExplain) {
  std::vector<SettledAngles> settled;
  for (const double pitch : {-0.03, 0.0, 0.03}) {
    for (const double yaw : {-0.02, 0.01, 0.02}) {
      settled.push_back({{0.7 * pitch + 1.0, -0.7 * pitch, 0.6 * yaw + 0.1 * pitch, 0.2 - 0.6 * yaw}, pitch, yaw});
    }
  }
  const AngleCalibration calibration(settled);
  DOUBLES_EQUAL(0.0, calibration.residual(), 1e-12);
  const auto [pitch, yaw] =
      calibration.angles({0.7 * 0.015 + 1.0, -0.7 * 0.015, 0.6 * 0.007 + 0.1 * 0.015, 0.2 - 0.6 * 0.007});
  DOUBLES_EQUAL(0.015, pitch, 1e-12);
  DOUBLES_EQUAL(0.007, yaw, 1e-12);
  settled.front().pitch += 1e-3;
  CHECK_TRUE(AngleCalibration(settled).residual() > 1e-5);
}

TEST(AngleCalibration, NeedsPosesThatTurnAboutBothAngles) {
  const std::vector<SettledAngles> still(9);
  CHECK_THROWS(std::invalid_argument, AngleCalibration{still});
}

}  // namespace hotfire::analysis
