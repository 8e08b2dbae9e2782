// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/channel_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

constexpr double kFollows = 0.9;
constexpr double kRunsAgainst = -0.5;
/// A smaller error of scale is found as `sensor_scale`; friction that holds an engine back does not reach this.
constexpr double kLargestRatio = 5.0;
/// How near a ratio has to be to that of two units to be reported as such.
constexpr double kUnitMatch = 0.15;
/// Times the noise that the larger of measured and predicted motion has to be, and the smaller: below that a correlation
/// says nothing.
constexpr double kLeastMotion = 10.0;
constexpr double kLeastTrace = 1.5;

/// Sums over the compared rows of one channel in one record.
struct Moments {
  double rows = 0.0;
  double measured = 0.0;
  double model = 0.0;
  double measured_square = 0.0;
  double model_square = 0.0;
  double product = 0.0;
};

Moments moments(const Experiment& experiment, const std::vector<double>& predicted, std::size_t channel) {
  Moments m;
  const std::vector<double>& values = experiment.measured[channel];
  for (const Block& block : experiment.scored()) {
    for (std::size_t row = block.first; row < block.last; ++row) {
      m.rows += 1.0;
      m.measured += values[row];
      m.model += predicted[row];
      m.measured_square += values[row] * values[row];
      m.model_square += predicted[row] * predicted[row];
      m.product += values[row] * predicted[row];
    }
  }
  return m;
}

/// " (degrees taken for radians?)" for a ratio that two units of the same quantity have.
std::string unit_hint(double ratio) {
  struct Pair {
    double ratio;
    const char* bigger;
    const char* smaller;
  };
  constexpr std::array pairs{Pair{180.0 / std::numbers::pi, "degrees taken for radians", "radians taken for degrees"},
                             Pair{1000.0, "millimetres taken for metres", "metres taken for millimetres"},
                             Pair{1.0 / 0.0254, "inches taken for metres", "metres taken for inches"},
                             Pair{25.4, "millimetres taken for inches", "inches taken for millimetres"},
                             Pair{6894.757, "pascals taken for psi", "psi taken for pascals"}};
  for (const Pair& pair : pairs) {
    if (std::abs(std::log(ratio / pair.ratio)) < kUnitMatch) {
      return fmt::format(" ({}?)", pair.bigger);
    }
    if (std::abs(std::log(ratio * pair.ratio)) < kUnitMatch) {
      return fmt::format(" ({}?)", pair.smaller);
    }
  }
  return {};
}

/// How one channel of a record moves against its prediction; neither is set where both are too small to compare.
struct Comparison {
  std::size_t channel = 0;
  double correlation = 0.0;
  double ratio = 1.0;  ///< measured over predicted rms

  bool is_against() const { return correlation < kRunsAgainst; }
  bool is_out_of_scale() const { return correlation > kFollows && (ratio > kLargestRatio || ratio < 1.0 / kLargestRatio); }
};

Comparison comparison(std::size_t channel, const Moments& m, double noise) {
  const double measured = std::sqrt(std::max(0.0, m.measured_square / m.rows - std::pow(m.measured / m.rows, 2)));
  const double model = std::sqrt(std::max(0.0, m.model_square / m.rows - std::pow(m.model / m.rows, 2)));
  if (std::max(measured, model) < kLeastMotion * noise || std::min(measured, model) < kLeastTrace * noise) {
    return {channel};
  }
  return {channel, (m.product / m.rows - m.measured * m.model / (m.rows * m.rows)) / (measured * model), measured / model};
}

/// True if every channel of a record is at fault as one of them is: the fault is the command's then.
bool are_alike(const std::vector<Comparison>& found, const Comparison& one) {
  return found.size() > 1 && std::all_of(found.begin(), found.end(), [&](const Comparison& c) {
           return c.is_against() == one.is_against() && c.is_out_of_scale() == one.is_out_of_scale() &&
                  std::abs(std::log(c.ratio / one.ratio)) < kUnitMatch;
         });
}

void check(const Dataset& data, const std::string& record, const std::vector<Comparison>& found) {
  for (const Comparison& c : found) {
    const bool is_command = are_alike(found, c);
    const std::string moving = is_command ? "every channel" : "channel " + data.channels[c.channel];
    const char* culprit = is_command ? "the command" : "it";
    if (c.is_against()) {
      throw FileError(words::inverted_channel(record, moving, c.correlation, culprit));
    }
    if (c.is_out_of_scale()) {
      throw FileError(words::mis_scaled_channel(record, moving, c.ratio, c.correlation, culprit,
                                                unit_hint(is_command ? 1.0 / c.ratio : c.ratio)));
    }
  }
}

}  // namespace

void refuse_impossible_channels(const Dataset& data, const Prediction& prediction) {
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    std::vector<Comparison> found;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (!data.experiments[e].measured[c].empty()) {
        found.push_back(comparison(c, moments(data.experiments[e], prediction[e][c], c), data.noise[c]));
      }
    }
    check(data, data.experiments[e].name, found);
  }
}

}  // namespace hotfire::explain
