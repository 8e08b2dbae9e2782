// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace hotfire::explain {

/// A channel by row.
using Series = std::vector<double>;

/// Up to where the motion of an axis is known from measured channels [Hz]: about 12 Hz, or a fortieth of the sampling rate.
double smoothing_frequency(double period);

/// Zero-phase Gaussian low-pass with its half-power point at `frequency`; ends are continued by their last value.
Series smoothed(const Series& x, double period, double frequency);

/// Central differences; zero at the ends.
Series rate_of(const Series& x, double period);

/// Integral by the trapezoidal rule, less the straight line that fits it best: what an unknown start and the offset of a
/// sensor would add.
Series integral_of(const Series& rate, double period);

}  // namespace hotfire::explain
