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

}  // namespace hotfire::explain
