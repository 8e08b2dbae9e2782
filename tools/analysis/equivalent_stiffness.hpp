// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace hotfire::analysis {

/// Force of a spring over its deflection [N] of [m], odd and rising.
using SpringCurve = std::function<double(double)>;

/// Peak inertial force of a sine on an engine: J a b^2 / R for a rotation of amplitude a [rad] at b [rad/s] [SD eq. 4-5].
double peak_sine_force(double inertia, double moment_arm, double amplitude, double angular_frequency);

/// The spring constant that stores as much up to the peak force as the curve does,
///   K = 2 / x_max^2 integral_0^x_max f(x) dx,   f(x_max) = force   [SD eq. 6-7],
/// by Simpson's rule on 200 intervals. `stiffest` is the slope that the curve does not exceed: it bounds the search for
/// x_max.
double equivalent_stiffness(const SpringCurve& curve, double force, double stiffest);

/// The same about a bias load f0, "centered about the nominal load" [SD 2.2]: the spring constant that stores as much as the
/// curve does on the way from x0, f(x0) = f0, up to f0 + force and down to f0 - force,
///   K = 2 / (a^2 + b^2) (integral_0^a f(x0 + u) - f0 du + integral_0^b f0 - f(x0 - u) du),
///   f(x0 + a) = f0 + force, f(x0 - b) = f0 - force.
/// Without bias it is eq. 7.
double equivalent_stiffness_about(const SpringCurve& curve, double bias, double force, double stiffest);

/// Stiffness of two springs in series, 1 / (1 / one + 1 / other) [N/m] [SD eq. 3, 9].
double in_series(double one, double other);

/// The spring that makes `total` in series with `other` [N/m] [SD eq. 3, 9]; infinite where `total` is no softer than
/// `other`. A relative error of `total` grows by 1 / (1 - total / other), one of `other` by total / (other - total).
double beside(double other, double total);

/// What a load resonance is worked out from.
struct LoadResonance {
  double inertia;             ///< J [kg m^2]
  double moment_arm;          ///< R [m]
  double load_stiffness;      ///< K_L in series with the actuator [N/m]
  double duct_stiffness;      ///< K_n [N m/rad]
  double actuator_stiffness;  ///< slope that the actuator's curve does not exceed [N/m]
};

/// The load resonance sqrt((K_n + K_T R^2) / J) / 2 pi [Hz] with a total stiffness K_T [N/m] of actuator and load, damping
/// left out [SD eq. 2, 10].
double load_frequency(const LoadResonance& load, double total);

/// The total stiffness ((2 pi f)^2 J - K_n) / R^2 [N/m] that has its load resonance at f [Hz]: `load_frequency` solved for
/// K_T. A relative error of f comes out twice as large and by 1 + K_n / (K_T R^2) more, one of J by that alone.
double total_stiffness(const LoadResonance& load, double frequency);

/// The load resonance [Hz] of an engine that swings with `amplitude` [rad] about a `bias` load of its actuator [N], with the
/// actuator's stiffness equivalent to its curve within the peak force of that swing at that very frequency [SD eq. 2-7, 10].
/// Amplitude zero gives the slope of the curve at the bias.
double load_resonance(const LoadResonance& load, const SpringCurve& curve, double amplitude, double bias = 0.0);

}  // namespace hotfire::analysis
