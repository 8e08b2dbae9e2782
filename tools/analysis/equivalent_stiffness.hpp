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

/// The load resonance [Hz] of an engine that swings with `amplitude` [rad], with the actuator's stiffness equivalent to its
/// curve up to the peak force of that swing at that very frequency [SD eq. 2-7, 10]. Amplitude zero gives the slope of the
/// curve at rest.
double load_resonance(const LoadResonance& load, const SpringCurve& curve, double amplitude);

}  // namespace hotfire::analysis
