// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tools/analysis/welch.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::trials {

namespace {

ChannelSweep with_features(std::string channel, double amplitude, analysis::FrequencyResponse response,
                           const SweepGoal& goal) {
  ChannelSweep sweep{std::move(channel), amplitude, std::move(response), {}, {}};
  sweep.notch = analysis::find_notch(sweep.response, goal.lowest, goal.highest);
  sweep.peak = analysis::find_peak(sweep.response, goal.lowest, goal.highest);
  return sweep;
}

analysis::FrequencyResponse broadband(const Record& record, const std::vector<double>& command,
                                      const std::vector<double>& output, const SweepGoal& goal) {
  const auto rows = static_cast<std::size_t>(std::lround(goal.segment / record.period));
  if (rows < 8 || 2 * rows > record.rows) {
    throw FileError(fmt::format("{}: {:.6g} s long; allowed: at least two segments of {:g} s, or a command of stepped sines",
                                record.path.string(), static_cast<double>(record.rows) * record.period, goal.segment));
  }
  return analysis::welch_response(command, output, record.period, {rows}, 0.0, 0.4 / record.period);
}

}  // namespace

std::string channel_of(const std::string& name, const std::string& axis) {
  return axis.empty() ? name : fmt::format("{}.{}", name, axis);
}

const Channel& required_channel(const Record& record, const std::string& name, const std::string& axis) {
  const std::string full = channel_of(name, axis);
  require_channel(record, full, "the analysis needs it");
  return *record.find(full);
}

std::vector<ChannelSweep> analyse_sweep(const Record& record, const SweepGoal& goal) {
  const Channel& command = required_channel(record, "command", goal.axis);
  const std::vector<analysis::Dwell> dwells = analysis::find_dwells(command.values, record.period);
  const std::size_t in_dwells = std::accumulate(dwells.begin(), dwells.end(), std::size_t{0},
                                                [](std::size_t sum, const auto& dwell) { return sum + dwell.rows; });
  std::vector<ChannelSweep> sweeps;
  for (const std::string name : {"piston", "engine"}) {
    const Channel* output = record.find(channel_of(name, goal.axis));
    if (output == nullptr) {
      continue;
    }
    std::vector<double> values = output->values;
    if (name == "piston") {
      std::for_each(values.begin(), values.end(), [&goal](double& value) { value /= goal.moment_arm; });
    }
    if (2 * in_dwells < record.rows) {
      sweeps.push_back(with_features(name, 0.0, broadband(record, command.values, values, goal), goal));
      continue;
    }
    for (auto& own : analysis::sine_responses(command.values, values, record.period, dwells)) {
      sweeps.push_back(with_features(name, own.amplitude, std::move(own.response), goal));
    }
  }
  if (sweeps.empty()) {
    required_channel(record, "piston", goal.axis);
  }
  return sweeps;
}

const ChannelSweep* find_sweep(const std::vector<ChannelSweep>& sweeps, const std::string& channel, double amplitude) {
  const auto found = std::find_if(sweeps.begin(), sweeps.end(), [&](const ChannelSweep& sweep) {
    return sweep.channel == channel && std::abs(sweep.amplitude - amplitude) < 0.02 * amplitude;
  });
  return found == sweeps.end() ? nullptr : &*found;
}

ChannelSweep joined_sweep(const std::vector<ChannelSweep>& sweeps, const std::string& channel, const SweepGoal& goal) {
  analysis::FrequencyResponse all;
  for (const ChannelSweep& sweep : sweeps) {
    if (sweep.channel == channel) {
      all.insert(all.end(), sweep.response.begin(), sweep.response.end());
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.frequency < b.frequency; });
  return with_features(channel, 0.0, std::move(all), goal);
}

}  // namespace hotfire::trials
