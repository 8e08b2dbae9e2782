// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// Three modes under a smooth random force, with the accelerations of three places, stepped by fourth-order Runge-Kutta of
/// its own: shares no code with the model. `joint(position, rate)`: force of the joint that the declared model does not
/// have.
inline Record jointed_structure(const std::function<double(double, double)>& joint, double noise, unsigned seed = 2017) {
  constexpr std::size_t kOwnModes = 3;
  constexpr std::array<double, kOwnModes> kOwnFrequency{5.1, 7.4, 11.9};
  constexpr std::array<double, kOwnModes> kOwnDamping{0.012, 0.015, 0.01};
  constexpr std::array<double, kOwnModes> kOwnMobility{0.02, 0.035, 0.05};
  constexpr std::array<double, kOwnModes> kOwnJoint{0.3, -0.9, 0.6};
  constexpr std::array<std::array<double, kOwnModes>, 3> kOwnShape{{{1.0, 1.0, 1.0}, {0.7, -0.4, 0.2}, {0.4, 0.6, -1.1}}};
  constexpr double kOwnPeriod = 0.0025;
  constexpr int kOwnSteps = 10;
  constexpr double kTurns = 2.0 * std::numbers::pi;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> phases(60);
  for (double& phase : phases) {
    phase = kTurns * std::generate_canonical<double, 53>(generator);
  }
  const auto force_at = [&](double t) {
    double force = 0.0;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      force += 12.0 * std::cos(kTurns * (2.0 + 0.2 * static_cast<double>(k)) * t + phases[k]);
    }
    return force;
  };
  using Motion = std::array<double, 2 * kOwnModes>;
  const auto rate_of = [&](double t, const Motion& y) {
    double position = 0.0;
    double rate = 0.0;
    for (std::size_t k = 0; k < kOwnModes; ++k) {
      position += kOwnJoint[k] * y[2 * k];
      rate += kOwnJoint[k] * y[2 * k + 1];
    }
    const double held = joint(position, rate);
    Motion d{};
    for (std::size_t k = 0; k < kOwnModes; ++k) {
      const double w = kTurns * kOwnFrequency[k];
      d[2 * k] = y[2 * k + 1];
      d[2 * k + 1] =
          kOwnMobility[k] * (force_at(t) - kOwnJoint[k] * held) - 2.0 * kOwnDamping[k] * w * y[2 * k + 1] - w * w * y[2 * k];
    }
    return d;
  };
  const auto moved = [](const Motion& y, const Motion& d, double h) {
    Motion result = y;
    for (std::size_t i = 0; i < y.size(); ++i) {
      result[i] += h * d[i];
    }
    return result;
  };
  Record record;
  record.name = "structure.csv";
  record.path = record.name;
  record.period = kOwnPeriod;
  record.rows = 8000;
  record.channels = {
      {"force", "N", {}}, {"acceleration", "m/s^2", {}}, {"acceleration2", "m/s^2", {}}, {"acceleration3", "m/s^2", {}}};
  Motion y{};
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * kOwnPeriod;
    record.channels[0].values.push_back(force_at(t));
    const Motion now = rate_of(t, y);
    for (std::size_t place = 0; place < 3; ++place) {
      double acceleration = 0.0;
      for (std::size_t k = 0; k < kOwnModes; ++k) {
        acceleration += kOwnShape[place][k] * now[2 * k + 1];
      }
      record.channels[place + 1].values.push_back(acceleration + noise * normal(generator));
    }
    const double h = kOwnPeriod / kOwnSteps;
    for (int i = 0; i < kOwnSteps; ++i) {
      const double s = t + i * h;
      const Motion k1 = rate_of(s, y);
      const Motion k2 = rate_of(s + h / 2, moved(y, k1, h / 2));
      const Motion k3 = rate_of(s + h / 2, moved(y, k2, h / 2));
      const Motion k4 = rate_of(s + h, moved(y, k3, h));
      for (std::size_t j = 0; j < y.size(); ++j) {
        y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
      }
    }
  }
  return record;
}

/// The structure as a modal test at low force gives it.
inline ModelFile declared_structure() {
  ModelFile model;
  ModalParameters declared;
  std::get<0>(declared.modes) = {5.09, 0.0125, 0.0202, 1.0, 0.3, 0.7, 0.4};
  std::get<1>(declared.modes) = {7.42, 0.0145, 0.0345, 1.0, -0.9, -0.4, 0.6};
  std::get<2>(declared.modes) = {11.88, 0.0103, 0.0505, 1.0, 0.6, 0.2, -1.1};
  model.parameters = declared;
  for (const char* mode : {"mode1", "mode2", "mode3"}) {
    model.tolerance[std::string(mode) + ".frequency"] = 0.01;
    model.tolerance[std::string(mode) + ".damping_ratio"] = 0.1;
    model.tolerance[std::string(mode) + ".mobility"] = 0.03;
  }
  return model;
}

}  // namespace hotfire::test
