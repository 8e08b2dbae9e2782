// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/equivalent_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hotfire::analysis {

namespace {

/// The deflection at which an odd, rising curve reaches a force.
double deflection_at(const SpringCurve& curve, double force, double stiffest) {
  if (force <= 0.0) {
    return force < 0.0 ? -deflection_at(curve, -force, stiffest) : 0.0;
  }
  double low = force / stiffest;
  double high = 2.0 * low;
  while (curve(high) < force && high < 1e6 * low) {
    low = high;
    high *= 2.0;
  }
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (curve(middle) < force ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// An odd curve that is given for deflections from zero up.
double on_both_sides(const SpringCurve& curve, double deflection) {
  return deflection < 0.0 ? -curve(-deflection) : curve(deflection);
}

}  // namespace

double peak_sine_force(double inertia, double moment_arm, double amplitude, double angular_frequency) {
  return inertia * amplitude * angular_frequency * angular_frequency / moment_arm;
}

double equivalent_stiffness(const SpringCurve& curve, double force, double stiffest) {
  return equivalent_stiffness_about(curve, 0.0, force, stiffest);
}

double equivalent_stiffness_about(const SpringCurve& curve, double bias, double force, double stiffest) {
  constexpr int kIntervals = 200;
  const double slope = 1.001 * stiffest;
  const double start = deflection_at(curve, bias, slope);
  double work = 0.0;
  double squares = 0.0;
  for (const double direction : {1.0, -1.0}) {
    const double way = direction * (deflection_at(curve, bias + direction * force, slope) - start);
    const auto beyond_bias = [&](double u) { return direction * (on_both_sides(curve, start + direction * u) - bias); };
    const double width = way / kIntervals;
    double sum = beyond_bias(way);
    for (int i = 1; i < kIntervals; ++i) {
      sum += (i % 2 == 1 ? 4.0 : 2.0) * beyond_bias(i * width);
    }
    work += sum * width / 3.0;
    squares += way * way;
  }
  return 2.0 / squares * work;
}

double in_series(double one, double other) { return 1.0 / (1.0 / one + 1.0 / other); }

double beside(double other, double total) {
  return total < other ? 1.0 / (1.0 / total - 1.0 / other) : std::numeric_limits<double>::infinity();
}

double load_frequency(const LoadResonance& load, double total) {
  return std::sqrt((load.duct_stiffness + total * load.moment_arm * load.moment_arm) / load.inertia) /
         (2.0 * std::numbers::pi);
}

double total_stiffness(const LoadResonance& load, double frequency) {
  const double w = 2.0 * std::numbers::pi * frequency;
  return (w * w * load.inertia - load.duct_stiffness) / (load.moment_arm * load.moment_arm);
}

double load_resonance(const LoadResonance& load, const SpringCurve& curve, double amplitude, double bias) {
  constexpr double kLeastForce = 1e-3;  // N: the slope at rest
  double frequency = 0.0;
  double own = load.actuator_stiffness;
  // The force follows the frequency, which follows the stiffness; each round shrinks the error by the stiffness's share.
  for (int round = 0; round < 50; ++round) {
    frequency = load_frequency(load, in_series(own, load.load_stiffness));
    const double force = peak_sine_force(load.inertia, load.moment_arm, amplitude, 2.0 * std::numbers::pi * frequency);
    own = equivalent_stiffness_about(curve, bias, std::max(force, kLeastForce), load.actuator_stiffness);
  }
  return frequency;
}

}  // namespace hotfire::analysis
