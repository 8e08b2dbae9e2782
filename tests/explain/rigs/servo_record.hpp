// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "tests/model/support/servo_reference.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::test {

constexpr double kServoNoise = 2e-5;  // of the load's position, which moves by some 0.2

/// A servo under steps and smooth random motion of its setpoint. The record has the position of the load and the angle of
/// the motor. `delay` [s]: of the setpoint.
inline Record servo_record(const ServoEffects& effects, double delay = 0.0, unsigned seed = 2026) {
  constexpr double kSamplePeriod = 0.001;
  constexpr int kFine = 20;
  const ServoReference reference(servo(), effects);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> phases(20);
  for (double& phase : phases) {
    phase = 6.2831853 * std::generate_canonical<double, 53>(generator);
  }
  Record record;
  record.name = "servo.csv";
  record.path = record.name;
  record.period = kSamplePeriod;
  record.rows = 8000;
  record.channels = {{"setpoint", "m", {}}, {"position", "m", {}}, {"motor_position", "rad", {}}};
  std::vector<double>& setpoints = record.channels[0].values;
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * kSamplePeriod;
    double smooth = 0.0;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      smooth += 0.015 * std::sin((0.7 + 0.9 * static_cast<double>(k)) * t + phases[k]);
    }
    const double step = 0.1 * (static_cast<double>(row / 1000 % 3) - 1.0);
    // It begins at rest.
    setpoints.push_back(t < 0.1 ? 0.0 : std::min(1.0, 4.0 * (t - 0.1)) * smooth + step);
  }
  const auto late = static_cast<std::size_t>(std::lround(delay / kSamplePeriod));
  ServoReference::Vector y{};
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[1].values.push_back(y[4] + kServoNoise * normal(generator));
    record.channels[2].values.push_back(y[2] + 100.0 * kServoNoise * normal(generator));
    for (int i = 0; i < kFine; ++i) {
      reference.advance(y, setpoints[row < late ? 0 : row - late], kSamplePeriod / kFine);
    }
  }
  return record;
}

/// The servo as its engineer declares it: masses, damping and stiffness are off by some percent.
inline ModelFile declared_servo() {
  ModelFile model;
  ElectromechanicalParameters declared = servo();
  declared.motor.inertia *= 1.04;
  declared.motor.damping *= 0.9;
  declared.mass.inertia *= 0.97;
  declared.mass.stiffness *= 1.03;
  declared.transmission.stiffness *= 0.95;
  model.parameters = declared;
  model.tolerance = {{"motor.inertia", 0.05},
                     {"motor.damping", 0.2},
                     {"mass.inertia", 0.05},
                     {"mass.stiffness", 0.05},
                     {"transmission.stiffness", 0.1}};
  return model;
}

}  // namespace hotfire::test
