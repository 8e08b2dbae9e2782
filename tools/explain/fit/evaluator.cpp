// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/evaluator.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>

#include "model/numerics/perturbed.hpp"
#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/experiment_run.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire::explain {

namespace {

/// A run beside three others under a changed parameter: as many as one wide register holds. More spill, and cost more each.
using Number = model::Perturbed<4>;
constexpr std::size_t kAtOnce = Number::kChanges;
/// Change of a coordinate for a difference quotient. The unit of a coordinate is a factor e or a tolerance, over which a
/// reading bends: the quotient is off by 1e-5 of itself. A run rounds by 1e-15 of a reading, the quotient by 1e-10, which is
/// a hundred-thousandth of the noise of a sensor of five digits.
constexpr double kChange = 1e-5;

/// The parameters that one simulation changes, each for itself.
struct Chunk {
  std::span<const FreeParameter> free;
  std::span<const double> u;
  std::span<const std::size_t> wanted;  ///< at most kAtOnce of them
  Eigen::Index first_column = 0;

  /// Parameter k and what it is under each change.
  Number value(std::size_t k) const {
    Number number(free[k].value(u[k]));
    change(k, number);
    return number;
  }

  void change(std::size_t k, Number& number) const {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] == k) {
        number.set_changed(static_cast<int>(i), number.value() + kChange * free[k].slope(u[k]));
      }
    }
  }

  template <class Parameters>
  void change_all(Parameters& parameters) const {
    std::size_t index = 0;
    model::visit_values(parameters, [&](Number& value) {
      for (const std::size_t k : wanted) {
        if (!free[k].is_initial_state() && free[k].index == index) {
          change(k, value);
        }
      }
      ++index;
    });
  }
};

/// Puts the derivatives of one experiment's readings where they belong in the Jacobian, row by row in ascending order.
class Writer {
 public:
  Writer(const Dataset& data, const std::vector<Stretch>& stretches, std::size_t experiment, Eigen::MatrixXd& jacobian)
      : jacobian_(jacobian), next_(data.channels.size(), 0), by_channel_(data.channels.size()) {
    for (const Stretch& s : stretches) {
      if (s.experiment == experiment) {
        by_channel_[s.channel].push_back({&s, 1.0 / (kChange * data.experiments[experiment].noise[s.channel])});
      }
    }
  }

  /// False if a derivative is not finite.
  bool write(std::size_t row, std::size_t channel, const Number& reading, const Chunk& chunk) {
    const auto& parts = by_channel_[channel];
    std::size_t& next = next_[channel];
    while (next < parts.size() && row >= parts[next].stretch->last) {
      ++next;
    }
    if (next >= parts.size() || row < parts[next].stretch->first) {
      return true;
    }
    const auto [stretch, scale] = parts[next];
    const auto i = static_cast<Eigen::Index>(stretch->offset + row - stretch->first);
    double sum = 0.0;
    for (int change = 0; change < static_cast<int>(chunk.wanted.size()); ++change) {
      const double slope = (reading.changed(change) - reading.value()) * scale;
      jacobian_(i, chunk.first_column + change) = slope;
      sum += slope;
    }
    return std::isfinite(sum);
  }

 private:
  /// A stretch of this experiment, and the factor from a difference to a slope over noise.
  struct Part {
    const Stretch* stretch;
    double scale;
  };

  Eigen::MatrixXd& jacobian_;
  std::vector<std::size_t> next_;
  std::vector<std::vector<Part>> by_channel_;
};

/// The experiments of a dataset, as a plant is stepped through them.
struct Course {
  const Dataset& data;
  std::span<const std::size_t> order;           ///< of the experiments, as threads take them
  std::function<int(const Experiment&)> steps;  ///< per row
  unsigned threads = 1;
};

/// Simulates all experiments and adds `shift`, if there is one. False if a state did not stay finite.
template <class Parameters>
bool simulate(const Parameters& parameters, const Course& course, std::span<const FreeParameter> free,
              std::span<const double> u, const Prediction& shift, Prediction& prediction) {
  const Dataset& data = course.data;
  const auto plants = plants_by_period<PlantOf<Parameters, double>>(data, parameters, course.steps);
  prediction.resize(data.experiments.size());
  std::atomic<bool> finite{true};
  parallel_for(data.experiments.size(), course.threads, [&](std::size_t task) {
    const std::size_t e = course.order[task];
    const Experiment& experiment = data.experiments[e];
    auto& channels = prediction[e];
    channels.resize(data.channels.size());
    for (std::vector<double>& channel : channels) {
      channel.resize(experiment.rows());
    }
    const auto& plant = *plants.at(experiment.period);
    const auto start = start_of<double>(data, e, free, [&](std::size_t k) { return free[k].value(u[k]); });
    auto state = initial_state(plant, data, experiment, start);
    if (!run_experiment(plant, data, experiment, state, course.steps(experiment),
                        [&](std::size_t row, const auto& readings) {
                          for (std::size_t c = 0; c < readings.size(); ++c) {
                            channels[c][row] = readings[c] + (shift.empty() ? 0.0 : shift[e][c][row]);
                          }
                        })) {
      finite = false;
    }
  });
  return finite;
}

/// Simulates all experiments beside changed parameters, once for every chunk. False if a state or a derivative did not stay
/// finite.
template <class Parameters>
bool simulate_changed(const Parameters& plain, const Course& course, const std::vector<Chunk>& chunks,
                      const std::vector<Stretch>& stretches, Eigen::MatrixXd& jacobian) {
  using Plant = PlantOf<Parameters, Number>;
  const Dataset& data = course.data;
  std::vector<std::map<double, std::unique_ptr<Plant>>> plants(chunks.size());
  parallel_for(chunks.size(), course.threads, [&](std::size_t c) {
    auto parameters = with_scalar<typename Plant::Parameters>(plain);
    chunks[c].change_all(parameters);
    plants[c] = plants_by_period<Plant>(data, parameters, course.steps);
  });
  std::atomic<bool> finite{true};
  parallel_for(chunks.size() * data.experiments.size(), course.threads, [&](std::size_t task) {
    const Chunk& chunk = chunks[task % chunks.size()];
    const std::size_t e = course.order[task / chunks.size()];
    const Experiment& experiment = data.experiments[e];
    const auto& plant = *plants[task % chunks.size()].at(experiment.period);
    const auto start = start_of<Number>(data, e, chunk.free, [&](std::size_t k) { return chunk.value(k); });
    // Such a state is tens of kilobytes: it lives on the heap, not on a thread's stack.
    auto state = std::make_unique<typename Plant::State>(initial_state(plant, data, experiment, start));
    Writer writer(data, stretches, e, jacobian);
    bool good = true;
    const auto sink = [&](std::size_t row, const auto& readings) {
      for (std::size_t channel = 0; channel < readings.size(); ++channel) {
        good = writer.write(row, channel, readings[channel], chunk) && good;
      }
    };
    const bool ran = run_experiment(plant, data, experiment, *state, course.steps(experiment), sink);
    if (!ran || !good) {
      finite = false;
    }
  });
  return finite;
}

/// Steps per row of an experiment.
int steps_of(const ModelParameters& base, const Experiment& experiment, Resolution resolution) {
  const int fine =
      std::visit([&]<class Parameters>(
                     const Parameters& own) { return steps_in_row<PlantOf<Parameters, double>>(own, experiment.period); },
                 base);
  return steps_at(resolution, fine);
}

}  // namespace

int steps_at(Resolution resolution, int fine) {
  if (resolution == Resolution::finest) {
    return 2 * fine;
  }
  const int times_longer = resolution == Resolution::fine ? 1 : resolution == Resolution::coarse ? 2 : 4;
  return (fine + times_longer - 1) / times_longer;
}

Prediction at_thinned_rows(const Prediction& full, const Dataset& data, const Dataset& thin) {
  Prediction result(full.size());
  for (std::size_t e = 0; e < full.size(); ++e) {
    const auto every = static_cast<std::size_t>(std::lround(thin.experiments[e].period / data.experiments[e].period));
    for (const std::vector<double>& channel : full[e]) {
      std::vector<double>& rows = result[e].emplace_back();
      for (std::size_t row = 0; row < channel.size(); row += every) {
        rows.push_back(channel[row]);
      }
    }
  }
  return result;
}

Evaluator::Evaluator(const Dataset& data, Resolution resolution, Resolution slopes)
    : data_(data), resolution_(resolution), slopes_(slopes), longest_first_(data.experiments.size()) {
  std::iota(longest_first_.begin(), longest_first_.end(), std::size_t{0});
  std::stable_sort(longest_first_.begin(), longest_first_.end(),
                   [&](std::size_t a, std::size_t b) { return data.experiments[a].rows() > data.experiments[b].rows(); });
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (experiment.measured[c].empty()) {
        continue;
      }
      for (const Block& block : experiment.fitted) {
        stretches_.push_back({e, c, block.first, block.last, fit_rows_});
        fit_rows_ += block.last - block.first;
      }
    }
  }
}

ModelParameters with_values(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u) {
  ModelParameters parameters = base;
  std::size_t index = 0;
  visit_values(parameters, [&](double& value) {
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (!free[k].is_initial_state() && free[k].index == index) {
        value = free[k].value(u[k]);
      }
    }
    ++index;
  });
  return parameters;
}

bool Evaluator::predict(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u,
                        unsigned threads, Prediction& prediction, Zeros& zeros) const {
  const Course course{data_, longest_first_, [&](const Experiment& e) { return steps_of(base, e, resolution_); }, threads};
  const bool finite = std::visit([&](const auto& own) { return simulate(own, course, free, u, shift_, prediction); },
                                 with_values(base, free, u));
  zeros = add_zeros(data_, prediction);
  return finite;
}

bool Evaluator::predict(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u,
                        unsigned threads, Prediction& prediction) const {
  Zeros zeros;
  return predict(base, free, u, threads, prediction, zeros);
}

Evaluator Evaluator::shifted(const Prediction& own, const Prediction& finer) const {
  Evaluator moved = *this;
  moved.shift_ = finer;
  for (std::size_t e = 0; e < own.size(); ++e) {
    for (std::size_t c = 0; c < own[e].size(); ++c) {
      std::transform(finer[e][c].begin(), finer[e][c].end(), own[e][c].begin(), moved.shift_[e][c].begin(), std::minus<>{});
    }
  }
  return moved;
}

Eigen::VectorXd Evaluator::residuals(const Prediction& prediction) const {
  Eigen::VectorXd residual(static_cast<Eigen::Index>(fit_rows_));
  for (const Stretch& s : stretches_) {
    const auto& measured = data_.experiments[s.experiment].measured[s.channel];
    const auto& predicted = prediction[s.experiment][s.channel];
    for (std::size_t row = s.first; row < s.last; ++row) {
      residual(static_cast<Eigen::Index>(s.offset + row - s.first)) =
          (predicted[row] - measured[row]) / data_.experiments[s.experiment].noise[s.channel];
    }
  }
  // A prediction has the most likely zero, which leaves 1 / (1 + n s^2) of a mean; whitened by the prior it is the root.
  for_each_zero([&](Eigen::Index first, Eigen::Index rows, double precision) {
    auto part = residual.segment(first, rows);
    part.array() += part.mean() * (std::sqrt(1.0 + precision) - 1.0);
  });
  return residual;
}

template <class F>
void Evaluator::for_each_zero(F&& f) const {
  for (std::size_t i = 0; i < stretches_.size();) {
    const Stretch& first = stretches_[i];
    std::size_t rows = 0;
    for (; i < stretches_.size() && stretches_[i].experiment == first.experiment && stretches_[i].channel == first.channel;
         ++i) {
      rows += stretches_[i].last - stretches_[i].first;
    }
    const double precision = zero_precision(data_.experiments[first.experiment], first.channel);
    if (precision > 0.0) {
      f(static_cast<Eigen::Index>(first.offset), static_cast<Eigen::Index>(rows), precision);
    }
  }
}

std::vector<double> Evaluator::squares_by_channel(const Eigen::VectorXd& residual) const {
  std::vector<double> square(data_.channels.size(), 0.0);
  for (const Stretch& s : stretches_) {
    square[s.channel] +=
        residual.segment(static_cast<Eigen::Index>(s.offset), static_cast<Eigen::Index>(s.last - s.first)).squaredNorm();
  }
  return square;
}

bool Evaluator::differentiate(const ModelParameters& base, std::span<const FreeParameter> free, std::span<const double> u,
                              std::span<const std::size_t> wanted, unsigned threads, Eigen::MatrixXd& jacobian) const {
  jacobian.resize(static_cast<Eigen::Index>(fit_rows_), static_cast<Eigen::Index>(wanted.size()));
  std::vector<Chunk> chunks;
  for (std::size_t first = 0; first < wanted.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, wanted.size() - first);
    chunks.push_back({free, u, wanted.subspan(first, count), static_cast<Eigen::Index>(first)});
  }
  const Course course{data_, longest_first_, [&](const Experiment& e) { return steps_of(base, e, slopes_); }, threads};
  const bool finite =
      std::visit([&](const auto& own) { return simulate_changed(own, course, chunks, stretches_, jacobian); },
                 with_values(base, free, u));
  for_each_zero([&](Eigen::Index first, Eigen::Index rows, double precision) {
    auto part = jacobian.middleRows(first, rows);
    part.rowwise() -= (1.0 - 1.0 / std::sqrt(1.0 + precision)) * part.colwise().mean();
  });
  return finite;
}

}  // namespace hotfire::explain
