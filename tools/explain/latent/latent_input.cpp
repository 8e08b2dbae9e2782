// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/latent_input.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "tools/explain/fit/slopes.hpp"
#include "tools/explain/latent/row_products.hpp"

namespace hotfire::explain {

namespace {

/// Correlation times of the signal, in time constants of the servo: slower than its transients and faster than a profile; of
/// a sensor also as fast as the servo, and as fast as its oil.
constexpr double kSlowest = 8.5;
constexpr std::array kFaster{1.4, 0.24};
/// Deviation of the start from the simulated one, over the scales of the states: a twentieth of what full opening does.
constexpr double kStartDeviation = 0.05;
/// Deviation that a row adds to each state, over its scale: what the linear flow is wrong by at least. Far below what a
/// sensor resolves, and far above the rounding that would make a covariance indefinite where friction sticks and slips.
constexpr double kFlowDeviation = 1e-7;
/// Deviation of a state, over its scale, beyond which a flow is not linear: what full opening does. Where a seal breaks away
/// and its friction falls with speed, an unknown deviation grows by a thousand in a row, and by more in the next one.
constexpr double kLargestDeviation = 1.0;
/// Sizes of the signal over its scale that are looked at, as logarithms: from what no sensor sees to all that the plant has.
constexpr double kSmallest = -16.1;  // ln 1e-7
constexpr double kLargest = 0.7;     // ln 2
constexpr double kCoarse = 2.8;      // a grid of seven
constexpr int kRefinements = 2;

constexpr int kSignal = kFlowStates;
constexpr int kFilterStates = kFlowStates + 1;
/// Rows of the filter's matrices: those of its states and some that stay zero. As many as whole registers hold are added and
/// multiplied in a third of the time.
constexpr int kFilterRows = 12;
using FilterMatrix = Eigen::Matrix<double, kFilterRows, kFilterStates>;
using FilterVector = Eigen::Matrix<double, kFilterRows, 1>;
using Means = Eigen::Matrix<double, kFilterRows, Eigen::Dynamic>;

auto states_of(const FilterVector& vector) { return vector.head<kFilterStates>(); }

/// One scalar measurement of a row and what the filter made of it.
struct Update {
  FilterVector row;   ///< of the observation matrix
  FilterVector gain;  ///< K
  double innovation = 0.0;
  double variance = 1.0;
};

/// What the smoother needs of a row.
struct Step {
  FilterVector mean;
  FilterMatrix covariance;
  std::vector<Update> updates;
};

class Filter {
 public:
  Filter(const LatentProblem& problem, const std::optional<LatentPlace>& place, const LatentPrior& prior)
      : problem_(problem),
        place_(place),
        variance_(prior.deviation * prior.deviation),
        correlation_time_(prior.correlation_time) {}

  /// Observation of channel c over its noise in a record.
  FilterVector observation(const Experiment& experiment, std::size_t channel) const {
    FilterVector row = FilterVector::Zero();
    const double noise = experiment.noise[channel];
    row(kReadState[channel]) = problem_.scales.state(kReadState[channel]) / noise;
    if (place_ && !place_->port && place_->channel == channel) {
      row(kSignal) = problem_.scales.reading[channel] / noise;
    }
    return row;
  }

  double memory(const Experiment& experiment) const {
    return std::exp(-experiment.period / (correlation_time_ * problem_.scales.time));
  }

  FilterMatrix start() const {
    FilterMatrix covariance = FilterMatrix::Zero();
    covariance.diagonal().head<kFlowStates>().setConstant(kStartDeviation * kStartDeviation);
    covariance(kSignal, kSignal) = variance_;
    return covariance;
  }

  FilterMatrix transition(const RowFlow& flow, double memory) const {
    FilterMatrix matrix = FilterMatrix::Zero();
    matrix.topLeftCorner<kFlowStates, kFlowStates>() = flow.transition;
    if (place_ && place_->port) {
      matrix.col(kSignal).head<kFlowStates>() = flow.response.col(static_cast<int>(*place_->port));
    }
    matrix(kSignal, kSignal) = memory;
    return matrix;
  }

  /// Least squares of the innovations on the parameters, with the tolerances as prior: the log likelihood.
  double likelihood(Eigen::VectorXd& move) const {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(problem_.expected.size(), problem_.expected.size());
    Eigen::VectorXd right = problem_.expected;
    double square = problem_.expected.squaredNorm();
    double logarithms = 0.0;
    double count = 0.0;
    for (std::size_t e = 0; e < problem_.data.experiments.size(); ++e) {
      const Experiment& experiment = problem_.data.experiments[e];
      const double kept = memory(experiment);
      const auto parameters = static_cast<Eigen::Index>(problem_.own[e].size());
      RowProducts products(parameters + 1);  // innovations over their deviation: what is left first, then its slopes
      Eigen::RowVectorXd innovation(parameters + 1);
      Means means = Means::Zero(kFilterRows, parameters + 1);
      FilterMatrix covariance = start();
      for (std::size_t row = 0; row < experiment.rows(); ++row) {
        for (std::size_t c = 0; c < kReadState.size(); ++c) {
          const double left = problem_.left[e](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c));
          if (std::isnan(left)) {
            continue;
          }
          const FilterVector seen = observation(experiment, c);
          const FilterVector spread = covariance.lazyProduct(states_of(seen));
          const double variance = 1.0 + seen.dot(spread);
          innovation(0) = left;
          innovation.tail(parameters) = problem_.sensitivity[e][c].col(static_cast<Eigen::Index>(row)).transpose();
          innovation -= seen(kReadState[c]) * means.row(kReadState[c]) + seen(kSignal) * means.row(kSignal);
          means += (spread / variance).lazyProduct(innovation);
          covariance -= (spread / variance).lazyProduct(states_of(spread).transpose());
          products.add([&](auto&& values, auto&&) { values = innovation.transpose() / std::sqrt(variance); });
          logarithms += std::log(variance);
          count += 1.0;
        }
        if (row + 1 < experiment.rows()) {
          const FilterMatrix moves = transition(problem_.flows[e].rows[row], kept);
          means = moves.lazyProduct(means.topRows<kFilterStates>()).eval();
          advance(moves, problem_.flows[e].rows[row], kept, covariance);
        }
      }
      products.flush();
      square += products.own(0, 0);
      normal(problem_.own[e], problem_.own[e]) += products.own.bottomRightCorner(parameters, parameters);
      right(problem_.own[e]) += products.own.bottomLeftCorner(parameters, 1);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(normal);
    move = factor.solve(right);
    const double determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    return -0.5 * (square - right.dot(move) + logarithms + determinant + count * std::log(2.0 * std::numbers::pi));
  }

  /// Lets the flow of an experiment forget every state whose deviation it would make larger than `kLargestDeviation`,
  /// without any signal. One set of forgotten states for all places keeps their likelihoods comparable.
  void forget_growth(std::size_t e, std::vector<RowFlow>& rows) const {
    FilterMatrix covariance = start();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      measure(e, row, covariance);
      const FilterMatrix measured = covariance;
      do {
        covariance = measured;
        advance(transition(rows[row], 0.0), rows[row], 0.0, covariance);
      } while (rows[row].forget(covariance.diagonal().head<kFlowStates>().array() > kLargestDeviation * kLargestDeviation));
    }
  }

  /// One experiment with the parameters moved, forward.
  std::vector<Step> forward(std::size_t e, const Eigen::VectorXd& move) const {
    const Experiment& experiment = problem_.data.experiments[e];
    const double kept = memory(experiment);
    const Eigen::VectorXd moved = move(problem_.own[e]);
    std::vector<Step> steps(experiment.rows());
    FilterVector mean = FilterVector::Zero();
    FilterMatrix covariance = start();
    for (std::size_t row = 0; row < experiment.rows(); ++row) {
      steps[row].mean = mean;
      steps[row].covariance = covariance;
      for (std::size_t c = 0; c < kReadState.size(); ++c) {
        const double left = problem_.left[e](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c));
        if (std::isnan(left)) {
          continue;
        }
        Update update;
        update.row = observation(experiment, c);
        const FilterVector spread = covariance * states_of(update.row);
        update.variance = 1.0 + update.row.dot(spread);
        update.gain = spread / update.variance;
        update.innovation =
            left - problem_.sensitivity[e][c].col(static_cast<Eigen::Index>(row)).dot(moved) - update.row.dot(mean);
        mean += update.gain * update.innovation;
        covariance.noalias() -= spread * states_of(update.gain).transpose();
        steps[row].updates.push_back(update);
      }
      if (row + 1 < experiment.rows()) {
        const FilterMatrix moves = transition(problem_.flows[e].rows[row], kept);
        mean = (moves * states_of(mean)).eval();
        advance(moves, problem_.flows[e].rows[row], kept, covariance);
      }
    }
    return steps;
  }

 private:
  /// The covariance after what the sensors read in a row.
  void measure(std::size_t e, std::size_t row, FilterMatrix& covariance) const {
    for (std::size_t c = 0; c < kReadState.size(); ++c) {
      if (!std::isnan(problem_.left[e](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c)))) {
        const FilterVector seen = observation(problem_.data.experiments[e], c);
        const FilterVector spread = covariance.lazyProduct(states_of(seen));
        covariance -= (spread / (1.0 + seen.dot(spread))).lazyProduct(states_of(spread).transpose());
      }
    }
  }

  /// The covariance a row later. A state that the row forgets is as unknown as at the start.
  void advance(const FilterMatrix& moves, const RowFlow& flow, double kept, FilterMatrix& covariance) const {
    // Of this size Eigen's product for large matrices takes several times as long.
    const FilterMatrix spread = moves.lazyProduct(covariance.topRows<kFilterStates>());
    covariance = spread.lazyProduct(moves.topRows<kFilterStates>().transpose());
    for (int i = 0; i < kFlowStates; ++i) {
      const double added = flow.forgets(i) ? kStartDeviation : kFlowDeviation;
      covariance(i, i) += added * added;
    }
    covariance(kSignal, kSignal) += variance_ * (1.0 - kept * kept);
    auto square = covariance.topRows<kFilterStates>();
    square = (0.5 * (square + square.transpose())).eval();
  }

  const LatentProblem& problem_;
  const std::optional<LatentPlace> place_;
  double variance_;
  double correlation_time_;
};

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

LatentProblem latent_problem(const Dataset& logged, const Dataset& data, const Fitted& around, unsigned threads) {
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
  problem.flows = linear_flow(data, parameters, problem.scales, threads);
  const Filter filter(problem, std::nullopt, {});
  for (std::size_t e = 0; e < problem.flows.size(); ++e) {
    filter.forget_growth(e, problem.flows[e].rows);
  }
  return problem;
}

double likelihood_without(const LatentProblem& problem) {
  Eigen::VectorXd move;
  return Filter(problem, std::nullopt, {}).likelihood(move);
}

LatentInput input_of(const LatentProblem& problem, const LatentPlace& place, const LatentPrior& prior) {
  LatentInput input;
  input.prior = prior;
  input.log_likelihood = Filter(problem, place, prior).likelihood(input.move);
  return input;
}

LatentInput most_likely_input(const LatentProblem& problem, const LatentPlace& place) {
  LatentInput best;
  const auto look = [&](const LatentPrior& prior) {
    LatentInput input = input_of(problem, place, prior);
    if (best.prior.deviation == 0.0 || input.log_likelihood > best.log_likelihood) {
      best = std::move(input);
    }
  };
  for (double logarithm = kSmallest; logarithm < kLargest + 0.5; logarithm += kCoarse) {
    look({std::exp(logarithm), kSlowest});
  }
  // The plant smooths what acts at a port. Only what a sensor adds is read as fast as it is. Beyond 1 / T the density of the
  // signal is that of its deviation's square over T.
  const double density = best.prior.deviation / std::sqrt(kSlowest);
  if (!place.port) {
    for (const double time : kFaster) {
      look({density * std::sqrt(time), time});
    }
  }
  double step = kCoarse;
  for (int i = 0; i < kRefinements; ++i) {
    step *= 0.4;
    const LatentPrior center = best.prior;
    look({center.deviation * std::exp(-step), center.correlation_time});
    look({center.deviation * std::exp(step), center.correlation_time});
  }
  return best;
}

void smooth(const LatentProblem& problem, const LatentPlace& place, LatentInput& input) {
  const Filter filter(problem, place, input.prior);
  std::vector<double> square(kReadState.size(), 0.0);
  std::vector<double> rows(kReadState.size(), 0.0);
  for (std::size_t e = 0; e < problem.data.experiments.size(); ++e) {
    const Experiment& experiment = problem.data.experiments[e];
    const double kept = filter.memory(experiment);
    const std::vector<Step> steps = filter.forward(e, input.move);
    const Eigen::VectorXd moved = input.move(problem.own[e]);
    Eigen::VectorXd signal(static_cast<Eigen::Index>(experiment.rows()));
    Eigen::MatrixXd states(kFlowStates, static_cast<Eigen::Index>(experiment.rows()));
    FilterVector adjoint = FilterVector::Zero();
    for (std::size_t row = experiment.rows(); row-- > 0;) {
      const Step& step = steps[row];
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
