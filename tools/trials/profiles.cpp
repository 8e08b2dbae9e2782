// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/profiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace hotfire::trials {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

std::size_t rows_of(double seconds) { return static_cast<std::size_t>(std::lround(seconds / kPeriod)); }

}  // namespace

std::vector<double> spaced(double lowest, double highest, int count) {
  std::vector<double> frequencies;
  frequencies.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    frequencies.push_back(lowest * std::pow(highest / lowest, k / std::max(1.0, count - 1.0)));
  }
  return frequencies;
}

std::vector<double> stepped_sines(const std::vector<SineBand>& bands, double least_seconds) {
  return stepped_sines(bands, [least_seconds](double) { return least_seconds; });
}

std::vector<double> stepped_sines(const std::vector<SineBand>& bands, const LeastDwell& least_seconds) {
  constexpr double kFewestPeriods = 8.0;
  std::vector<double> command;
  // Time runs on from dwell to dwell, so that one of no whole number of rows does not shift the phase of the next.
  double start = 0.0;
  for (const SineBand& band : bands) {
    for (const double frequency : band.frequencies) {
      const double periods = std::max(kFewestPeriods, std::ceil(least_seconds(frequency) * frequency));
      const double end = start + periods / frequency;
      for (std::size_t row = command.size(); static_cast<double>(row) * kPeriod < end; ++row) {
        command.push_back(band.amplitude * std::sin(kTurn * frequency * (static_cast<double>(row) * kPeriod - start)));
      }
      start = end;
    }
  }
  command.push_back(0.0);
  return command;
}

std::vector<SineBand> green_run_sines(bool yaw) {
  SineBand high{radians(0.8), {}};
  for (int k = 0; k <= 28; ++k) {
    high.frequencies.push_back(7.0 + 0.25 * k);
  }
  const SineBand low{radians(0.4), spaced(0.4, 6.25, 16)};
  return yaw ? std::vector{low, high} : std::vector{high, low};
}

Record green_run_record() {
  const std::vector<SineBand> bands = green_run_sines();
  const std::vector<double> low = stepped_sines({bands.back()});
  const double seconds = static_cast<double>(low.size()) * kPeriod;
  std::vector<double> high = stepped_sines({bands.front()}, seconds / static_cast<double>(bands.front().frequencies.size()));
  // Whole periods make the upper band a little longer; the lower waits.
  const std::size_t rows = std::max(low.size(), high.size());
  const auto joined = [rows](std::vector<double> first, const std::vector<double>& second) {
    first.resize(rows, 0.0);
    first.insert(first.end(), second.begin(), second.end());
    first.resize(2 * rows, 0.0);
    return first;
  };
  Record record = command_record(joined(high, low), "command.pitch");
  record.channels.push_back({"command.yaw", "rad", joined(low, high)});
  return record;
}

std::vector<double> multisine(double amplitude, double lowest, double highest, double length, int repeats, unsigned seed) {
  const std::size_t rows = rows_of(length);
  std::vector<double> once(rows, 0.0);
  // The engine's numbers are the same everywhere; a distribution's are not.
  std::mt19937 random(seed);
  for (int k = 1; k <= static_cast<int>(highest * length + 1e-9); ++k) {
    const double phase = kTurn * static_cast<double>(random()) / 4294967296.0;
    if (k / length >= lowest * (1.0 - 1e-9)) {
      for (std::size_t row = 0; row < rows; ++row) {
        once[row] += std::sin(kTurn * k * static_cast<double>(row) / static_cast<double>(rows) + phase);
      }
    }
  }
  const auto [least, most] = std::minmax_element(once.begin(), once.end());
  const double peak = std::max({*most, -*least, 1e-300});
  std::vector<double> command;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const double value : once) {
      command.push_back(amplitude * value / peak);
    }
  }
  return command;
}

std::vector<double> steps(const std::vector<double>& amplitudes, double hold) {
  std::vector<double> command(rows_of(hold), 0.0);
  for (const double amplitude : amplitudes) {
    for (const double level : {amplitude, 0.0, -amplitude, 0.0}) {
      command.insert(command.end(), rows_of(hold), level);
    }
  }
  return command;
}

Record command_record(std::vector<double> command, const std::string& channel) {
  Record record;
  record.path = record.name = "profile";
  record.period = kPeriod;
  record.rows = command.size();
  record.channels.push_back({channel, "rad", std::move(command)});
  return record;
}

}  // namespace hotfire::trials
