// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/black_box.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "tools/simulate/path.hpp"

namespace hotfire::explain {

namespace {

using Series = std::vector<double>;

constexpr double kClosestRows = 2e-3;  // [s]
constexpr std::size_t kHighestOrder = 4;
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
  Series result(values.size());
  for (std::size_t row = 0; row < values.size(); ++row) {
    double value = values[row];
    for (std::size_t i = 1; i <= a.size(); ++i) {
      value -= a[i - 1] * (row >= i ? result[row - i] : before);
    }
    result[row] = value;
  }
  return result;
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

/// One least-squares pass on signals that were put through 1 / `poles`. Nothing if they do not determine the coefficients.
std::optional<LinearModel> least_squares(const std::vector<Signals>& all, std::size_t order, std::size_t delay,
                                         const Series& poles) {
  const auto size = static_cast<Eigen::Index>(2 * order);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd row_of(size);
  for (const Signals& signals : all) {
    const Series input = poles.empty() ? signals.input : through_poles(signals.input, poles);
    const Series output = poles.empty() ? signals.output : through_poles(signals.output, poles);
    for (const Block& block : signals.experiment->fitted) {
      for (std::size_t row = block.first + order; row < block.last; ++row) {
        for (std::size_t i = 0; i < order; ++i) {
          row_of(static_cast<Eigen::Index>(i)) = -output[row - 1 - i];
          row_of(static_cast<Eigen::Index>(order + i)) = at(input, row, delay + i);
        }
        normal.selfadjointView<Eigen::Lower>().rankUpdate(row_of);
        right += row_of * output[row];
      }
    }
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0)) {
    return std::nullopt;
  }
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  Eigen::MatrixXd scaled =
      inverse.asDiagonal() * Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>()) * inverse.asDiagonal();
  scaled.diagonal().array() += 1e-14 * static_cast<double>(size);  // rounding of the normal equations
  const Eigen::VectorXd found = inverse.asDiagonal() * scaled.ldlt().solve(inverse.asDiagonal() * right);
  if (!found.allFinite()) {
    return std::nullopt;
  }
  LinearModel model{delay, {}, {}};
  model.a.assign(found.data(), found.data() + order);
  model.b.assign(found.data() + order, found.data() + 2 * order);
  return model;
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

/// The best delay of an order: a grid of widening steps, then every delay about the best.
Scored best_delay(const std::vector<Signals>& all, std::size_t channel, std::size_t order, std::size_t longest) {
  Scored best;
  const auto look = [&](std::size_t delay) {
    Scored tried = steiglitz_mcbride(all, channel, order, delay);
    if (tried.model && (!best.model || tried.error < best.error)) {
      best = std::move(tried);
    }
  };
  std::size_t step = 1;
  for (std::size_t delay = 0; delay <= longest; delay += step) {
    look(delay);
    step = std::max<std::size_t>(1, delay / 2);
  }
  if (best.model) {
    const std::size_t middle = best.model->delay;
    for (std::size_t delay = middle - std::min<std::size_t>(middle, 2); delay <= std::min(middle + 2, longest); ++delay) {
      look(delay);
    }
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

BlackBox black_box(const Dataset& full) {
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
    Scored best;
    const double noise = data.noise[c] * data.noise[c];
    for (std::size_t order = 1; order <= kHighestOrder && !(best.model && best.error <= noise); ++order) {
      Scored next = best_delay(all, c, order, longest);
      const double worth = (1.0 - kWorthAnOrder) * (1.0 - kWorthAnOrder);
      if (next.model && (!best.model || next.error < worth * best.error)) {
        best = std::move(next);
      }
    }
    box.channels[c] = std::move(best.model);
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
