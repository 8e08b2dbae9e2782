// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/black_box.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/path.hpp"

namespace hotfire::explain {

namespace {

using Series = std::vector<double>;

constexpr double kClosestRows = 2e-3;  // [s]
/// Orders that are tried with every delay.
constexpr std::size_t kHighestOrder = 4;
/// Orders that are tried after these with delays near the best one, each as long as the one before was worth it.
constexpr std::array<std::size_t, 3> kHigherOrders{6, 8, 12};
constexpr std::size_t kNearDelay = 2;  // [rows]
constexpr double kLongestDelay = 0.1;  // [s]
constexpr int kPasses = 8;
/// Share of the error that a further order has to take off.
constexpr double kWorthAnOrder = 0.02;
constexpr double kSamePeriod = 1e-6;

/// One record's input and output about where it starts.
struct Signals {
  const Experiment* experiment = nullptr;
  Series input;
  Series output;
};

/// A channel of an axis or of a moved body has a zero of its own, which a constant takes up; a mass starts where it is.
bool has_zero(const Experiment& experiment, std::size_t channel) { return experiment.zero_deviation[channel] > 0.0; }

/// Mean of a series over the rows that a fit sees.
double fitted_mean(const Experiment& experiment, const Series& values) {
  double sum = 0.0;
  double rows = 0.0;
  for (const Block& block : experiment.fitted) {
    for (std::size_t row = block.first; row < block.last; ++row) {
      sum += values[row];
    }
    rows += static_cast<double>(block.last - block.first);
  }
  return rows > 0.0 ? sum / rows : 0.0;
}

std::vector<Signals> signals_of(const Dataset& data, std::size_t channel) {
  std::vector<Signals> all;
  for (const Experiment& experiment : data.experiments) {
    if (experiment.measured[channel].empty() || experiment.fitted.empty()) {
      continue;
    }
    Signals signals{&experiment, experiment.input, experiment.measured[channel]};
    const bool free = has_zero(experiment, channel);
    const double input = free ? fitted_mean(experiment, signals.input) : 0.0;
    const double output = free ? fitted_mean(experiment, signals.output) : signals.output.front();
    std::ranges::for_each(signals.input, [&](double& value) { value -= input; });
    std::ranges::for_each(signals.output, [&](double& value) { value -= output; });
    all.push_back(std::move(signals));
  }
  return all;
}

double at(const Series& values, std::size_t row, std::size_t back) {
  return row >= back ? values[row - back] : values.front();
}

/// y_k = values_k - sum a_i y_(k-i): values through 1 / A, from the steady state under the first.
Series through_poles(const Series& values, const Series& a) {
  double gain = 1.0;
  for (const double coefficient : a) {
    gain += coefficient;
  }
  const double before = std::abs(gain) > 1e-12 ? values.front() / gain : 0.0;
  Series padded(a.size(), before);
  padded.resize(a.size() + values.size());
  for (std::size_t row = 0; row < values.size(); ++row) {
    double value = values[row];
    const double* earlier = padded.data() + a.size() + row;
    for (const double coefficient : a) {
      value -= coefficient * *--earlier;
    }
    padded[a.size() + row] = value;
  }
  return {padded.begin() + static_cast<std::ptrdiff_t>(a.size()), padded.end()};
}

/// The output from rest, or from the steady state under the first input if `steady`.
Series output_of(const LinearModel& model, const Series& input, bool steady) {
  Series driven(input.size(), 0.0);
  for (std::size_t row = 0; row < input.size(); ++row) {
    for (std::size_t i = 0; i < model.b.size(); ++i) {
      driven[row] += model.b[i] * (row >= model.delay + i ? input[row - model.delay - i] : steady ? input.front() : 0.0);
    }
  }
  if (!steady) {
    driven.front() = 0.0;
  }
  return through_poles(driven, model.a);
}

bool is_stable(const Series& a) {
  const auto n = static_cast<Eigen::Index>(a.size());
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(0, i) = -a[static_cast<std::size_t>(i)];
    if (i > 0) {
      companion(i, i - 1) = 1.0;
    }
  }
  constexpr double kRounding = 1e-9;  // a free mass has poles at one
  return companion.eigenvalues().cwiseAbs().maxCoeff() <= 1.0 + kRounding;
}

/// One least-squares pass on signals that were put through 1 / `poles`, in scalars S. Nothing if they do not determine the
/// coefficients.
template <class S>
std::optional<LinearModel> least_squares_in(const std::vector<Signals>& all, std::size_t order, std::size_t delay,
                                            const Series& poles) {
  using Vector = Eigen::Matrix<S, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;
  const auto size = static_cast<Eigen::Index>(2 * order);
  Matrix normal = Matrix::Zero(size, size);
  Vector right = Vector::Zero(size);
  // A product of many rows takes a fraction of the time of as many outer products.
  constexpr Eigen::Index kTogether = 64;
  Matrix rows(size, kTogether);
  Vector outputs(kTogether);
  Eigen::Index waiting = 0;
  const auto add_waiting = [&] {
    normal.template selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(waiting));
    right.noalias() += rows.leftCols(waiting) * outputs.head(waiting);
    waiting = 0;
  };
  for (const Signals& signals : all) {
    const Series input = poles.empty() ? signals.input : through_poles(signals.input, poles);
    const Series output = poles.empty() ? signals.output : through_poles(signals.output, poles);
    for (const Block& block : signals.experiment->fitted) {
      for (std::size_t row = block.first + order; row < block.last; ++row) {
        for (std::size_t i = 0; i < order; ++i) {
          rows(static_cast<Eigen::Index>(i), waiting) = S(-output[row - 1 - i]);
          rows(static_cast<Eigen::Index>(order + i), waiting) = S(at(input, row, delay + i));
        }
        outputs(waiting) = S(output[row]);
        if (++waiting == kTogether) {
          add_waiting();
        }
      }
    }
  }
  add_waiting();
  const Vector scale = normal.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > S(0))) {
    return std::nullopt;
  }
  const Vector inverse = scale.cwiseInverse();
  Matrix scaled = inverse.asDiagonal() * Matrix(normal.template selfadjointView<Eigen::Lower>()) * inverse.asDiagonal();
  // Rounding of the normal equations.
  scaled.diagonal().array() += S(50) * std::numeric_limits<S>::epsilon() * static_cast<S>(size);
  const Vector found = inverse.asDiagonal() * scaled.ldlt().solve(inverse.asDiagonal() * right);
  if (!found.allFinite()) {
    return std::nullopt;
  }
  LinearModel model{delay, {}, {}};
  for (std::size_t i = 0; i < order; ++i) {
    model.a.push_back(static_cast<double>(found(static_cast<Eigen::Index>(i))));
    model.b.push_back(static_cast<double>(found(static_cast<Eigen::Index>(order + i))));
  }
  return model;
}

/// In the normal equations of a high order, poles that are close together differ beyond the digits of a double.
std::optional<LinearModel> least_squares(const std::vector<Signals>& all, std::size_t order, std::size_t delay,
                                         const Series& poles) {
  return order > kHighestOrder ? least_squares_in<long double>(all, order, delay, poles)
                               : least_squares_in<double>(all, order, delay, poles);
}

/// Mean square of the simulation error on the rows that a fit sees; the constant of a record is free where it has a zero.
double simulation_error(const LinearModel& model, const std::vector<Signals>& all, std::size_t channel) {
  double square = 0.0;
  double rows = 0.0;
  for (const Signals& signals : all) {
    const bool free = has_zero(*signals.experiment, channel);
    Series left = output_of(model, signals.input, free);
    for (std::size_t row = 0; row < left.size(); ++row) {
      left[row] -= signals.output[row];
    }
    const double constant = free ? fitted_mean(*signals.experiment, left) : 0.0;
    for (const Block& block : signals.experiment->fitted) {
      for (std::size_t row = block.first; row < block.last; ++row) {
        square += (left[row] - constant) * (left[row] - constant);
      }
      rows += static_cast<double>(block.last - block.first);
    }
  }
  return rows > 0.0 ? square / rows : 0.0;
}

struct Scored {
  std::optional<LinearModel> model;
  double error = 0.0;
};

/// The best of the passes.
Scored steiglitz_mcbride(const std::vector<Signals>& all, std::size_t channel, std::size_t order, std::size_t delay) {
  Scored best;
  Series poles;
  double before = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    auto model = least_squares(all, order, delay, poles);
    if (!model || !is_stable(model->a)) {
      break;
    }
    poles = model->a;
    const double error = simulation_error(*model, all, channel);
    if (std::isfinite(error) && (!best.model || error < best.error)) {
      best = {std::move(model), error};
    }
    constexpr double kStands = 1e-3;
    if (pass > 0 && std::abs(error - before) < kStands * before) {
      break;
    }
    before = error;
  }
  return best;
}

void keep_better(Scored& best, Scored tried) {
  if (tried.model && (!best.model || tried.error < best.error)) {
    best = std::move(tried);
  }
}

/// The records of one channel, and how its models are searched for.
struct Search {
  const std::vector<Signals>& all;
  std::size_t channel;
  std::size_t longest;  ///< delay [rows]
  unsigned threads;
};

/// The best of some delays; the first of equal ones.
Scored best_of_delays(const Search& search, std::size_t order, const std::vector<std::size_t>& delays) {
  std::vector<Scored> tried(delays.size());
  parallel_for(delays.size(), search.threads,
               [&](std::size_t i) { tried[i] = steiglitz_mcbride(search.all, search.channel, order, delays[i]); });
  Scored best;
  for (Scored& one : tried) {
    keep_better(best, std::move(one));
  }
  return best;
}

/// The best of every delay about one.
Scored near_delay(const Search& search, std::size_t order, std::size_t middle) {
  std::vector<std::size_t> delays;
  for (std::size_t delay = middle - std::min(middle, kNearDelay); delay <= std::min(middle + kNearDelay, search.longest);
       ++delay) {
    delays.push_back(delay);
  }
  return best_of_delays(search, order, delays);
}

/// The best delay of an order: a grid of widening steps, then every delay about the best.
Scored best_delay(const Search& search, std::size_t order) {
  std::vector<std::size_t> grid;
  for (std::size_t delay = 0; delay <= search.longest; delay += std::max<std::size_t>(1, delay / 2)) {
    grid.push_back(delay);
  }
  Scored best = best_of_delays(search, order, grid);
  if (best.model) {
    keep_better(best, near_delay(search, order, best.model->delay));
  }
  return best;
}

/// The best order and delay for one channel, whose noise has the variance `noise`.
Scored best_order(const Search& search, double noise) {
  Scored best;
  const auto is_worth_it = [&](const Scored& next) {
    constexpr double kWorth = (1.0 - kWorthAnOrder) * (1.0 - kWorthAnOrder);
    return next.model && (!best.model || next.error < kWorth * best.error);
  };
  const auto is_met = [&] { return best.model && best.error <= noise; };
  for (std::size_t order = 1; order <= kHighestOrder && !is_met(); ++order) {
    Scored next = best_delay(search, order);
    if (is_worth_it(next)) {
      best = std::move(next);
    }
  }
  for (const std::size_t order : kHigherOrders) {
    if (is_met() || !best.model || best.model->order() < kHighestOrder) {
      break;
    }
    Scored next = near_delay(search, order, best.model->delay);
    if (!is_worth_it(next)) {
      break;
    }
    best = std::move(next);
  }
  return best;
}

}  // namespace

Dataset for_black_box(const Dataset& data) {
  Dataset thin = thinned(data, kClosestRows);
  if (data.input_is_path) {
    // The force along a path needs the position one row later, which a delay cannot give.
    for (Experiment& experiment : thin.experiments) {
      experiment.input.push_back(Path(experiment.input, 1).at(static_cast<std::ptrdiff_t>(experiment.rows())));
      experiment.input.erase(experiment.input.begin());
    }
  }
  return thin;
}

BlackBox black_box(const Dataset& full, unsigned threads) {
  const Dataset data = for_black_box(full);
  BlackBox box;
  const double period = data.experiments.front().period;
  if (std::ranges::any_of(data.experiments,
                          [&](const Experiment& e) { return std::abs(e.period - period) > kSamePeriod * period; })) {
    return box;
  }
  box.period = period;
  box.channels.resize(data.channels.size());
  const auto longest = static_cast<std::size_t>(kLongestDelay / period);
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const std::vector<Signals> all = signals_of(data, c);
    if (all.empty()) {
      continue;
    }
    box.channels[c] = best_order({all, c, longest, threads}, data.noise[c] * data.noise[c]).model;
  }
  return box;
}

Prediction simulated(const BlackBox& box, const Dataset& data) {
  Prediction prediction(data.experiments.size());
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      Series& channel = prediction[e].emplace_back(experiment.rows(), 0.0);
      if (!box.channels[c] || experiment.measured[c].empty()) {
        continue;
      }
      const bool free = has_zero(experiment, c);
      channel = output_of(*box.channels[c], experiment.input, free);
      if (!free) {
        std::ranges::for_each(channel, [&](double& value) { value += experiment.measured[c].front(); });
      }
    }
  }
  add_zeros(data, prediction);
  return prediction;
}

}  // namespace hotfire::explain
