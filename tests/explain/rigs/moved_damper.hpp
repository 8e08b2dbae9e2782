// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::test {

/// A damper on a shaker, in closed form: the force of the declared damper and of what is missing in it, along a smooth
/// random path whose velocity and acceleration are exact. It shares no code with the model. `missing(position, velocity)`
/// [N]; the damper takes up a free play of `half_width` [m] before it moves. `noise`: rms of the force [N].
inline Record moved_damper(const std::function<double(double, double)>& missing, double half_width, double noise,
                           unsigned seed = 1967) {
  constexpr double kBodyMass = 0.4;
  constexpr double kBodyDamping = 1200.0;
  constexpr double kSamplePeriod = 0.002;
  constexpr int kFine = 50;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> phases(24);
  for (double& phase : phases) {
    phase = 6.2831853 * std::generate_canonical<double, 53>(generator);
  }
  struct PathPoint {
    double x = 0.0;
    double v = 0.0;
    double a = 0.0;
  };
  const auto path = [&](double t) {
    PathPoint point;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const double w = 2.0 + 1.3 * static_cast<double>(k);
      const double size = 0.012 / (1.0 + 0.15 * static_cast<double>(k));
      point.x += size * std::cos(w * t + phases[k]);
      point.v -= size * w * std::sin(w * t + phases[k]);
      point.a -= size * w * w * std::cos(w * t + phases[k]);
    }
    return point;
  };
  Record record;
  record.name = "damper.csv";
  record.path = record.name;
  record.period = kSamplePeriod;
  record.rows = 6000;
  record.channels = {{"position", "m", {}}, {"force", "N", {}}};
  double taken_up = 0.0;
  bool follows = true;
  for (std::size_t row = 0; row < record.rows; ++row) {
    const PathPoint here = path(static_cast<double>(row) * kSamplePeriod);
    record.channels[0].values.push_back(here.x);
    const double of_damper = follows ? kBodyDamping * here.v : 0.0;
    record.channels[1].values.push_back(kBodyMass * here.a + of_damper + missing(here.x, here.v) +
                                        noise * normal(generator));
    for (int k = 0; k < kFine; ++k) {
      const double t = (static_cast<double>(row) + static_cast<double>(k) / kFine) * kSamplePeriod;
      const double moved = taken_up + path(t + kSamplePeriod / kFine).x - path(t).x;
      follows = std::abs(moved) >= half_width;
      taken_up = follows ? std::copysign(half_width, moved) : moved;
    }
  }
  return record;
}

/// The damper as its engineer declares it.
inline ModelFile declared_damper() {
  ModelFile model;
  ImposedMotionParameters declared;
  declared.body.inertia = 0.41;
  declared.body.damping = 1100.0;
  model.parameters = declared;
  model.tolerance = {{"body.inertia", 0.1}, {"body.damping", 0.2}};
  return model;
}

}  // namespace hotfire::test
