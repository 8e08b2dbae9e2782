// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace hotfire::explain {

/// Least and largest of the values that it has taken.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void take(const Extent& other) {
    take(other.low);
    take(other.high);
  }
};

/// Root mean square.
double root_mean_square(std::span<const double> values);

/// Noise rms of a uniformly sampled signal from its third differences: var = E[(d3 x)^2] / 20, which a smooth signal hardly
/// touches. The median of squares over short stretches is taken, so that edges in the signal do not count
/// [Garcia 2010 describes the family; von Neumann et al. 1941 the idea].
double noise_from_differences(std::span<const double> values);

/// The same of the quietest tenth of the stretches, where motion hardly shows even in slow rows: less than the noise by
/// about a fifth.
double quiet_noise(std::span<const double> values);

/// Below what the noise of a channel is no size of its sensor. A smooth, filtered or integrated channel has third
/// differences of next to nothing.
struct NoiseFloor {
  /// The least rms by which errors are weighed: that of the step by which the values are rounded, q / sqrt(12) [Widrow and
  /// Kollar 2008, Quantization Noise, eq. 4.17], or 1e-7 of the rms motion, to which a simulation is computed.
  double least = 0.0;
  /// The least rms that errors are said in times of: 1e-5 of the rms motion. No model of a rig agrees with a record to less:
  /// a clock, a gain or a geometry would have to be right to a hundred-thousandth.
  double reportable = 0.0;
};
NoiseFloor noise_floor(std::span<const double> values);

/// Autocorrelation at lags 0..last_lag, mean not removed (a bias is a part of the residual).
std::vector<double> autocorrelation(std::span<const double> values, std::size_t last_lag);

/// Statistical inefficiency g = 1 + 2 sum rho_k, summed to the first lag where two neighbours sum to nothing
/// [Geyer 1992, Practical Markov Chain Monte Carlo, initial positive sequence]. The effective sample size is n / g; g >= 1.
double statistical_inefficiency(std::span<const double> values);

/// The same of the products of two series that are unrelated: g = 1 + 2 sum rho_first rho_second. Both are of one length.
double joint_inefficiency(std::span<const double> first, std::span<const double> second);

}  // namespace hotfire::explain
