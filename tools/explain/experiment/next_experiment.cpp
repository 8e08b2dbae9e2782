// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/experiment/next_experiment.hpp"

#include <algorithm>
#include <cmath>

#include "model/numerics/step_size.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

namespace {

/// A longer profile has to separate them by this much more to be worth it.
constexpr double kWorthTheTime = 1.05;

/// Rms difference over noise of the largest used channel; zero if one of them can't be simulated.
double separation_under(const std::vector<double>& commands, const Dataset& data, const model::Simplex<double>& one,
                        const model::Simplex<double>& other, int steps) {
  std::vector<std::array<double, 3>> rows;
  rows.reserve(commands.size());
  auto state = one.steady(commands.front());
  const bool ran = run(one, commands, state, steps, [&](std::size_t, const auto& readings) { rows.push_back(readings); });
  std::array<double, 3> square{};
  state = other.steady(commands.front());
  const bool other_ran = ran && run(other, commands, state, steps, [&](std::size_t row, const auto& readings) {
                           for (std::size_t c = 0; c < square.size(); ++c) {
                             const double difference = (readings[c] - rows[row][c]) / data.noise[c];
                             square[c] += data.used[c] ? difference * difference : 0.0;
                           }
                         });
  return other_ran ? std::sqrt(*std::max_element(square.begin(), square.end()) / static_cast<double>(commands.size())) : 0.0;
}

}  // namespace

CommandLimits limits_of(const Dataset& data) {
  double largest = 0.0;
  for (const Experiment& experiment : data.experiments) {
    for (const double command : experiment.input) {
      largest = std::max(largest, std::abs(command));
    }
  }
  return {-largest, largest};
}

NextExperiment best_separation(const Dataset& data, const Fitted& one, const Fitted& other, const CommandLimits& limits,
                               unsigned threads) {
  const double period = data.experiments.front().period;
  const std::vector<TestProfile> profiles = test_profiles(limits, 0.1 / period);
  const int steps = model::steps_per_period(period);
  const auto plant_of = [&](const Fitted& fitted) {
    return model::Simplex<double>(std::get<SimplexParameters>(fitted.parameters()), period / steps);
  };
  const model::Simplex<double> first = plant_of(one);
  const model::Simplex<double> second = plant_of(other);
  std::vector<double> separation(profiles.size(), 0.0);
  parallel_for(profiles.size(), threads, [&](std::size_t i) {
    separation[i] = separation_under(profiles[i].commands(period), data, first, second, steps);
  });
  std::size_t best = 0;
  for (std::size_t i = 1; i < profiles.size(); ++i) {
    const double worth = profiles[i].seconds > profiles[best].seconds ? kWorthTheTime : 1.0 / kWorthTheTime;
    best = separation[i] > worth * separation[best] ? i : best;
  }
  NextExperiment next;
  if (profiles.empty()) {
    return next;
  }
  next.words = profiles[best].words;
  next.separation = separation[best];
  next.parts = profiles[best].parts;
  next.command.name = "next_experiment.csv";
  next.command.path = next.command.name;
  next.command.period = period;
  next.command.channels.push_back({"command", "rad", profiles[best].commands(period)});
  next.command.rows = next.command.channels.front().values.size();
  return next;
}

}  // namespace hotfire::explain
