// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// How well a prediction meets one part (fitted or held out) of the records, by channel.
struct ChannelFit {
  double rows = 0.0;
  double effective_rows = 0.0;  ///< rows over the statistical inefficiency of the residual
  double mean_square = 0.0;     ///< of residual over the noise of its record
  double rms = 0.0;             ///< in the channel's unit
  double max = 0.0;
  double bias = 0.0;
  double fit_percent = 0.0;  ///< 100 (1 - |residual| / |measured - mean|)
};

/// Fitted and held-out rows of every channel.
struct Goodness {
  std::vector<ChannelFit> fitted;
  std::vector<ChannelFit> held_out;

  /// Root mean square of residual over noise, all channels together.
  static double combined(const std::vector<ChannelFit>& part);
};

Goodness goodness(const Dataset& data, const Prediction& prediction);

/// Error of one model over that of another on the same part: rms over all channels or, if less, the geometric mean of the
/// channels' ratios. A channel that is far off for a reason of its own would hide in the first what happens to the others.
double error_ratio(const std::vector<ChannelFit>& with, const std::vector<ChannelFit>& without);

/// Bayesian information criterion of a model with `parameters` free values on the fitted rows, by the concentrated Gaussian
/// likelihood with the effective number of samples: sum over channels of n_eff ln(mean square) + parameters ln(n_eff)
/// [Schwarz 1978]. `effective` gives the sample sizes, so that two models are compared on the same ones.
double information_criterion(const std::vector<ChannelFit>& part, const std::vector<ChannelFit>& effective,
                             std::size_t parameters);

/// Measured minus predicted on a block of rows of a channel.
std::vector<double> residual_of(const Experiment& experiment, const std::vector<double>& predicted, std::size_t channel,
                                Block block);

/// Measured minus predicted on the rows of one record that are compared; empty where the record does not have the channel.
std::vector<double> scored_residual(const Experiment& experiment, const std::vector<std::vector<double>>& predicted,
                                    std::size_t channel);

/// What of the residual on all rows is not sensor noise: its rms over the noise, where the noise is estimated from the
/// residual's own third differences, record by record, or as large as was declared (or the floor) if that is more: third
/// differences do not see slow noise. Zero where the model reaches the noise, even if less was declared.
double excess_over_noise(const Dataset& data, const Prediction& prediction, std::size_t channel);

/// The largest of it over all channels.
double excess_over_noise(const Dataset& data, const Prediction& prediction);

/// How far two predictions are apart on the rows that are compared: rms over the noise, by channel.
std::vector<double> difference_over_noise(const Dataset& data, const Prediction& one, const Prediction& other);

}  // namespace hotfire::explain
