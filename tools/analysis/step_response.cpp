// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/step_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hotfire::analysis {

namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/// Seconds to the first row whose progress is at least `share`.
double time_to(std::span<const double> progress, double share, double period) {
  const auto found = std::find_if(progress.begin(), progress.end(), [share](double own) { return own >= share; });
  return found == progress.end() ? kNever : static_cast<double>(found - progress.begin()) * period;
}

double settling(std::span<const double> progress, double period) {
  std::size_t last = 0;
  for (std::size_t k = 0; k < progress.size(); ++k) {
    if (std::abs(progress[k] - 1.0) > 0.05) {
      last = k + 1;
    }
  }
  return last == progress.size() ? kNever : static_cast<double>(last) * period;
}

double longest_wait(std::span<const double> progress, double period) {
  constexpr double kNotice = 0.01;  // of the change: more than a sensor's noise
  const double arrival = time_to(progress, 0.9, period);
  const std::size_t rows =
      std::isnan(arrival) ? progress.size() : std::min(progress.size(), static_cast<std::size_t>(arrival / period) + 1);
  double furthest = 0.0;
  std::size_t since = 0;
  std::size_t longest = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    if (progress[k] > furthest + kNotice) {
      longest = std::max(longest, k - since);
      furthest = progress[k];
      since = k;
    }
  }
  return static_cast<double>(std::max(longest, rows - since)) * period;
}

StepResponse measure(std::span<const double> channel, std::size_t before, std::size_t end, double period,
                     StepResponse step) {
  const std::span<const double> rest = channel.subspan(step.row, end - step.row);
  const std::size_t quiet = std::max<std::size_t>(1, std::min(step.row - before, rest.size()) / 10);
  const double start = mean_of(channel.subspan(step.row - quiet, quiet));
  step.change = mean_of(rest.last(std::max<std::size_t>(1, rest.size() / 10))) - start;
  std::vector<double> progress;
  for (const double value : rest) {
    progress.push_back((value - start) / step.change);
  }
  step.rise_time = time_to(progress, 0.9, period) - time_to(progress, 0.1, period);
  step.overshoot = std::max(0.0, *std::max_element(progress.begin(), progress.end()) - 1.0);
  step.settling_time = settling(progress, period);
  step.hesitation = longest_wait(progress, period);
  return step;
}

}  // namespace

std::vector<StepResponse> step_responses(std::span<const double> command, std::span<const double> channel, double period,
                                         double hold) {
  const auto [least, most] = std::minmax_element(command.begin(), command.end());
  const double smallest = 0.01 * (*most - *least);
  std::vector<std::size_t> rows;
  for (std::size_t k = 1; k < command.size(); ++k) {
    if (std::abs(command[k] - command[k - 1]) > smallest) {
      rows.push_back(k);
    }
  }
  std::vector<StepResponse> steps;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : rows[i - 1];
    const std::size_t end = i + 1 == rows.size() ? command.size() : rows[i + 1];
    if (static_cast<double>(end - rows[i]) * period >= hold * (1.0 - 1e-9)) {
      steps.push_back(measure(channel, before, end, period, {rows[i], command[rows[i] - 1], command[rows[i]]}));
    }
  }
  return steps;
}

}  // namespace hotfire::analysis
