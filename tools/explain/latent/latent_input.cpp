// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/latent_input.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tools/explain/fit/slopes.hpp"
#include "tools/explain/latent/signal_filter.hpp"

namespace hotfire::explain {

namespace {

/// Correlation times of the signal, in time constants of the servo: slower than its transients and faster than a profile; of
/// a sensor also as fast as the servo, and as fast as its oil.
constexpr double kSlowest = 8.5;
constexpr std::array kFaster{1.4, 0.24};
/// Sizes of the signal over its scale that are looked at, as logarithms: from what no sensor sees to all that the plant has.
constexpr double kSmallest = -16.1;  // ln 1e-7
constexpr double kLargest = 0.7;     // ln 2
constexpr double kCoarse = 2.8;      // a grid of seven
constexpr int kRefinements = 2;

/// Takes a prior if the records are more likely under it, or if it is the first. True if it was taken.
bool improve(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& prior, LatentInput& best) {
  LatentInput input = input_of(problem, place, prior);
  const bool is_better = best.prior.deviation == 0.0 || input.log_likelihood > best.log_likelihood;
  if (is_better) {
    best = std::move(input);
  }
  return is_better;
}

/// The records with zeros that are known. Zeros that are integrated out of the residuals would correlate all rows of a
/// record, which a filter takes one by one.
Dataset without_zeros(Dataset data) {
  for (Experiment& experiment : data.experiments) {
    experiment.zero_deviation.assign(data.channels.size(), 0.0);
  }
  return data;
}

}  // namespace

std::vector<std::size_t> moved_beside(const Fitted& around) {
  std::vector<std::size_t> moved;
  for (std::size_t k = 0; k < around.free.size(); ++k) {
    if (!around.free[k].is_initial_state()) {
      moved.push_back(k);
    }
  }
  return moved;
}

LatentProblem latent_problem(const Dataset& logged, const Dataset& data, const Fitted& around, Resolution resolution,
                             unsigned threads) {
  const Dataset all_rows = without_zeros(logged);
  const Dataset kept_rows = without_zeros(data);
  const Evaluator evaluator(kept_rows, Resolution::coarse, Resolution::rough);
  const auto parameters = std::get<SimplexParameters>(around.parameters());
  LatentProblem problem{data, parameters, flow_scales(parameters), {}, {}, {}, {}, {}};
  const std::vector<std::size_t> moved = moved_beside(around);
  Prediction prediction;
  Eigen::MatrixXd jacobian;
  if (!Evaluator(all_rows, Resolution::coarse).predict(around.base, around.free, around.u, threads, prediction) ||
      !differentiate(evaluator, around.base, around.free, around.u, moved, Slopes::narrow, threads, jacobian)) {
    return problem;
  }
  const auto count = static_cast<Eigen::Index>(moved.size());
  Eigen::Index parameters_in_all = count;
  const Eigen::VectorXd residual = evaluator.residuals(at_thinned_rows(prediction, logged, data));
  std::vector<std::vector<Eigen::Index>> zero_row(data.experiments.size());
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    std::vector<Eigen::Index>& own = problem.own.emplace_back(moved.size());
    std::iota(own.begin(), own.end(), Eigen::Index{0});
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      zero_row[e].push_back(-1);
      if (zero_precision(data.experiments[e], c) > 0.0) {
        zero_row[e].back() = static_cast<Eigen::Index>(own.size());
        own.push_back(parameters_in_all++);
      }
    }
    const auto rows = static_cast<Eigen::Index>(data.experiments[e].rows());
    problem.left.emplace_back(Eigen::MatrixXd::Constant(rows, static_cast<Eigen::Index>(kReadState.size()),
                                                        std::numeric_limits<double>::quiet_NaN()));
    problem.sensitivity.emplace_back(kReadState.size(), Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(own.size()), rows));
  }
  problem.expected = Eigen::VectorXd::Zero(parameters_in_all);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t own = moved[static_cast<std::size_t>(k)];
    problem.expected(k) = around.free[own].is_declared() ? -around.u[own] : 0.0;
  }
  for (const Stretch& s : evaluator.stretches()) {
    const Experiment& experiment = data.experiments[s.experiment];
    Eigen::MatrixXd& sensitivity = problem.sensitivity[s.experiment][s.channel];
    const Eigen::Index zero = zero_row[s.experiment][s.channel];
    for (std::size_t row = s.first; row < s.last; ++row) {
      const auto i = static_cast<Eigen::Index>(s.offset + row - s.first);
      const auto at = static_cast<Eigen::Index>(row);
      problem.left[s.experiment](at, static_cast<Eigen::Index>(s.channel)) = -residual(i);
      sensitivity.col(at).head(count) = jacobian.row(i).transpose();
      if (zero >= 0) {
        sensitivity(zero, at) = experiment.zero_deviation[s.channel] / experiment.noise[s.channel];
      }
    }
  }
  problem.flows = linear_flow(data, parameters, problem.scales, resolution, threads);
  const SignalFilter filter(problem, std::nullopt, {});
  for (std::size_t e = 0; e < problem.flows.size(); ++e) {
    filter.forget_growth(e, problem.flows[e].rows);
  }
  return problem;
}

double likelihood_without(const LatentProblem& problem) {
  Eigen::VectorXd move;
  return SignalFilter(problem, std::nullopt, {}).likelihood(move);
}

LatentInput input_of(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& prior) {
  LatentInput input;
  input.prior = prior;
  input.log_likelihood = SignalFilter(problem, place, prior).likelihood(input.move);
  return input;
}

LatentInput most_likely_input(const LatentProblem& problem, const LatentPlace& place) {
  LatentInput best;
  for (double logarithm = kSmallest; logarithm < kLargest + 0.5; logarithm += kCoarse) {
    improve(problem, place, {std::exp(logarithm), kSlowest}, best);
  }
  // The plant smooths what acts at a port. Only what a sensor adds is read as fast as it is. Beyond 1 / T the density of the
  // signal is that of its deviation's square over T.
  const double density = best.prior.deviation / std::sqrt(kSlowest);
  if (!place.port) {
    for (const double time : kFaster) {
      improve(problem, place, {density * std::sqrt(time), time}, best);
    }
  }
  refine(problem, place, best);
  return best;
}

LatentInput input_downhill(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& from) {
  LatentInput best;
  improve(problem, place, from, best);
  for (const double factor : {std::exp(-kCoarse), std::exp(kCoarse)}) {
    while (improve(problem, place, {factor * best.prior.deviation, from.correlation_time}, best) &&
           best.prior.deviation > std::exp(kSmallest) && best.prior.deviation < std::exp(kLargest)) {
    }
    if (best.prior.deviation != from.deviation) {
      break;
    }
  }
  return best;
}

void refine(const LatentProblem& problem, const LatentPlace& place, LatentInput& input) {
  double step = kCoarse;
  for (int i = 0; i < kRefinements; ++i) {
    step *= 0.4;
    const LatentPrior center = input.prior;
    improve(problem, place, {center.deviation * std::exp(-step), center.correlation_time}, input);
    improve(problem, place, {center.deviation * std::exp(step), center.correlation_time}, input);
  }
}

void smooth(const LatentProblem& problem, const LatentPlace& place, LatentInput& input) {
  const SignalFilter filter(problem, place, input.prior);
  std::vector<double> square(kReadState.size(), 0.0);
  std::vector<double> rows(kReadState.size(), 0.0);
  for (std::size_t e = 0; e < problem.data.experiments.size(); ++e) {
    const Experiment& experiment = problem.data.experiments[e];
    const double kept = filter.memory(experiment);
    const std::vector<FilteredRow> steps = filter.forward(e, input.move);
    const Eigen::VectorXd moved = input.move(problem.own[e]);
    Eigen::VectorXd signal(static_cast<Eigen::Index>(experiment.rows()));
    Eigen::MatrixXd states(kFlowStates, static_cast<Eigen::Index>(experiment.rows()));
    FilterVector adjoint = FilterVector::Zero();
    for (std::size_t row = experiment.rows(); row-- > 0;) {
      const FilteredRow& step = steps[row];
      if (row + 1 < experiment.rows()) {
        const FilterVector later = adjoint;
        adjoint.head<kFilterStates>() = filter.transition(problem.flows[e].rows[row], kept).transpose() * later;
      }
      for (std::size_t i = step.updates.size(); i-- > 0;) {
        const Update& update = step.updates[i];
        adjoint -= update.row * (update.innovation / update.variance + update.gain.dot(adjoint));
      }
      const FilterVector smoothed = step.mean - step.covariance * states_of(adjoint);
      signal(static_cast<Eigen::Index>(row)) = smoothed(kSignal);
      states.col(static_cast<Eigen::Index>(row)) = smoothed.head<kFlowStates>();
      for (std::size_t c = 0; c < kReadState.size(); ++c) {
        const double left = problem.left[e](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c));
        if (!std::isnan(left)) {
          const double rest = left - problem.sensitivity[e][c].col(static_cast<Eigen::Index>(row)).dot(moved) -
                              filter.observation(experiment, c).dot(smoothed);
          square[c] += rest * rest;
          rows[c] += 1.0;
        }
      }
    }
    input.signal.push_back(std::move(signal));
    input.states.push_back(std::move(states));
  }
  for (std::size_t c = 0; c < square.size(); ++c) {
    input.leaves.push_back(rows[c] > 0.0 ? square[c] / rows[c] : 0.0);
  }
}

}  // namespace hotfire::explain
