// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "tools/explain/latent/latent_input.hpp"
#include "tools/explain/latent/row_products.hpp"

namespace hotfire::explain {

/// Deviation of the start from the simulated one, over the scales of the states: a twentieth of what full opening does.
inline constexpr double kStartDeviation = 0.05;
/// Deviation that a row adds to each state, over its scale: what the linear flow is wrong by at least. Far below what a
/// sensor resolves, and far above the rounding that would make a covariance indefinite where friction sticks and slips.
inline constexpr double kFlowDeviation = 1e-7;
/// Deviation of a state, over its scale, beyond which a flow is not linear: what full opening does. Where a seal breaks away
/// and its friction falls with speed, an unknown deviation grows by a thousand in a row, and by more in the next one.
inline constexpr double kLargestDeviation = 1.0;
inline constexpr int kSignal = kFlowStates;
inline constexpr int kFilterStates = kFlowStates + 1;
/// Rows of the filter's matrices: those of its states and some that stay zero. As many as whole registers hold are added and
/// multiplied in a third of the time.
inline constexpr int kFilterRows = 12;
using FilterMatrix = Eigen::Matrix<double, kFilterRows, kFilterStates>;
using FilterVector = Eigen::Matrix<double, kFilterRows, 1>;
using Means = Eigen::Matrix<double, kFilterRows, Eigen::Dynamic>;

inline auto states_of(const FilterVector& vector) { return vector.head<kFilterStates>(); }

/// One scalar measurement of a row and what the filter made of it.
struct Update {
  FilterVector row;   ///< of the observation matrix
  FilterVector gain;  ///< K
  double innovation = 0.0;
  double variance = 1.0;
};

/// What the smoother needs of a row.
struct FilteredRow {
  FilterVector mean;
  FilterMatrix covariance;
  std::vector<Update> updates;
};

/// Kalman filter of the plant's deviation from its simulation, along its linear flow, and of the unknown signal.
class SignalFilter {
 public:
  SignalFilter(const LatentProblem& problem, const std::optional<LatentPlace>& place, const LatentPrior& prior)
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
  std::vector<FilteredRow> forward(std::size_t e, const Eigen::VectorXd& move) const {
    const Experiment& experiment = problem_.data.experiments[e];
    const double kept = memory(experiment);
    const Eigen::VectorXd moved = move(problem_.own[e]);
    std::vector<FilteredRow> steps(experiment.rows());
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

}  // namespace hotfire::explain
