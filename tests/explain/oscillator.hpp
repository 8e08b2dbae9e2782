// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tools/explain/terms/candidates.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// A mass on a spring under a smooth random force, stepped by fourth-order Runge-Kutta of its own: shares no code with the
/// model. What the declared model lacks: the stiffness `cubic`, and detents, 2 pi / 8 m apart, of up to so many newtons.
/// `measured` is what the sensor reads, with the rms `noise` in its unit.
inline Record oscillator(double cubic, double noise, double detents = 0.0,
                         model::Direct<double>::Channel measured = model::Direct<double>::kPosition) {
  constexpr double kMass = 1.0;
  constexpr double kDamping = 1.5;
  constexpr double kStiffness = 100.0;
  constexpr double kPeriod = 0.01;
  constexpr int kSubsteps = 20;
  constexpr double kDetentWavenumber = 8.0;
  std::mt19937_64 generator(1918);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> phases(40);
  for (double& phase : phases) {
    phase = 6.2831853 * std::generate_canonical<double, 53>(generator);
  }
  const auto force_at = [&](double t) {
    double force = 0.0;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      force += 6.0 * std::cos((1.0 + 0.5 * static_cast<double>(k)) * t + phases[k]);
    }
    return force;
  };
  const auto acceleration = [&](double t, double x, double v) {
    return (force_at(t) - kDamping * v - kStiffness * x - cubic * x * x * x - detents * std::sin(kDetentWavenumber * x)) /
           kMass;
  };
  Record record;
  record.name = "oscillator.csv";
  record.period = kPeriod;
  record.rows = 6000;
  constexpr std::array<const char*, 3> kUnits{"m", "m/s", "m/s^2"};
  record.channels = {{"force", "N", {}}, {std::string(model::Direct<double>::channels[measured]), kUnits[measured], {}}};
  double x = 0.0;
  double v = 0.0;
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * kPeriod;
    record.channels[0].values.push_back(force_at(t));
    const std::array<double, 3> motion{x, v, acceleration(t, x, v)};
    record.channels[1].values.push_back(motion[measured] + noise * normal(generator));
    const double h = kPeriod / kSubsteps;
    for (int k = 0; k < kSubsteps; ++k) {
      const double s = t + k * h;
      const double k1 = acceleration(s, x, v);
      const double k2 = acceleration(s + h / 2, x + h / 2 * v, v + h / 2 * k1);
      const double k3 = acceleration(s + h / 2, x + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2);
      const double k4 = acceleration(s + h, x + h * v + h * h / 2 * k2, v + h * k3);
      x += h * v + h * h / 6 * (k1 + k2 + k3);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return record;
}

/// The oscillator as its engineer declares it: all three values off, the stiffness as given.
inline ModelFile declared_oscillator(double stiffness) {
  ModelFile model;
  DirectParameters declared;
  declared.mass.inertia = 1.02;
  declared.mass.damping = 1.3;
  declared.mass.stiffness = stiffness;
  model.parameters = declared;
  model.tolerance = {{"mass.inertia", 0.05}, {"mass.damping", 0.3}, {"mass.stiffness", 0.05}};
  return model;
}

/// A declared model at its declared values, as a fit of `data` starts.
inline explain::Fitted start_of(const ModelFile& declared, const explain::Dataset& data) {
  explain::Fitted start;
  start.base = declared.parameters;
  start.free = explain::declared_parameters(start.base, declared.tolerance);
  start.u.assign(start.free.size(), 0.0);
  start.temper.assign(data.channels.size(), 1.0);
  return start;
}

}  // namespace hotfire::test
