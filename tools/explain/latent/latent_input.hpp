// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/latent/linear_flow.hpp"

namespace hotfire::explain {

/// Where an unknown signal acts: at a port of the plant, or added to what a sensor reads.
struct LatentPlace {
  std::optional<Port> port;
  std::size_t channel = 0;  ///< of the sensor, where it is at no port
};

/// What is known before the signal is: the plant's flow, what the records leave, and how parameters move it.
struct LatentProblem {
  const Dataset& data;
  model::Simplex<double>::Parameters parameters;  ///< that the flow is simulated under
  FlowScales scales;
  std::vector<Flow> flows;                                ///< by experiment
  std::vector<Eigen::MatrixXd> left;                      ///< by experiment: measured minus predicted over noise, a column a
                                                          ///< channel; NaN where a row is not fitted
  std::vector<std::vector<Eigen::MatrixXd>> sensitivity;  ///< by experiment and channel: a row a parameter of `own`
  std::vector<std::vector<Eigen::Index>> own;             ///< by experiment: the parameters that move it
  Eigen::VectorXd expected;                               ///< prior mean of the parameters' move, in their coordinates
};

/// Indices of the free parameters of a fitted model that may move beside an unknown signal: all but those of the records'
/// starts. An effect that was fitted while the signal was missing represents some of it.
std::vector<std::size_t> moved_beside(const Fitted& around);

/// The problem about a fitted model. Empty flows if the model could not be simulated. Its parameters are those of
/// `moved_beside` in their coordinates, declared ones with their tolerances as prior, the others with one unit about where
/// they are; then the zero of every channel of every record, in its prior's deviation (zeros.hpp).
///
/// `data`: the rows of the problem, of which it keeps a reference. `logged`: the records that they were thinned from, or the
/// same. What the model leaves is that of `logged`: a rate limit makes something else of a command that is held longer.
/// `resolution`: of the flow.
LatentProblem latent_problem(const Dataset& logged, const Dataset& data, const Fitted& around, Resolution resolution,
                             unsigned threads);

/// What a signal is like before it is seen: an Ornstein-Uhlenbeck process.
struct LatentPrior {
  double deviation = 0.0;         ///< stationary rms of the signal over its scale
  double correlation_time = 1.0;  ///< in time constants of the servo
};

/// An unknown signal w(t) at one place.
struct LatentInput {
  double log_likelihood = 0.0;  ///< of the records, parameters and signal integrated out
  LatentPrior prior{};          ///< the most likely one
  Eigen::VectorXd move;         ///< of the problem's parameters
  std::vector<double> leaves;  ///< by channel: mean square over noise of what the smoothed signal leaves; filled by `smooth`
  std::vector<Eigen::VectorXd> signal;  ///< by experiment, a value a row, over its scale; filled by `smooth`
  std::vector<Eigen::MatrixXd> states;  ///< by experiment, deviations from the simulated states over their scales, a column
                                        ///< a row of the record; filled by `smooth`
};

/// Log likelihood of the records without any unknown signal.
double likelihood_without(const LatentProblem& problem);

/// A signal at `place` with a given prior: its likelihood, and the move of the problem's parameters beside it.
LatentInput input_of(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& prior);

/// The most likely size of a signal at `place`, and at a sensor its most likely correlation time: what a sensor adds may be
/// fast, and a slow prior would compare places by how well it fits.
///
/// w' = -w / T + white noise, T several time constants of the servo, at a sensor down to a fraction of one. The plant's
/// deviation, linear along its simulation, and w are the state of a Kalman filter; records reset them. Declared parameters
/// are constants over all records, zeros over one: the filter runs on their sensitivities beside the residuals, and their
/// move follows by least squares on the innovations, with tolerances and deviations as prior [de Jong 1991, The diffuse
/// Kalman filter, Annals of Statistics 19].
LatentInput most_likely_input(const LatentProblem& problem, const LatentPlace& place);

/// The most likely size of a signal at `place`, to a factor of four, from a prior that was likely beside another model: size
/// by size, as long as the next one is more likely. Seven evaluations of the filter become three.
LatentInput input_downhill(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& from);

/// Takes the size of a likely signal to a factor of 1.6, as `most_likely_input` does.
void refine(const LatentProblem& problem, const LatentPlace& place, LatentInput& input);

/// The same with signal and what is left, by a fixed-interval smoother [Bryson and Frazier 1963].
void smooth(const LatentProblem& problem, const LatentPlace& place, LatentInput& input);

}  // namespace hotfire::explain
