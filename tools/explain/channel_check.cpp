#include "tools/explain/channel_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tools/files/error.hpp"

namespace hotfire::explain {

namespace {

constexpr double kFollows = 0.9;
constexpr double kRunsAgainst = -0.5;
/// A smaller error of scale is found as `sensor_scale`; friction that holds an engine back does not reach this.
constexpr double kLargestRatio = 5.0;
/// How near a ratio has to be to that of two units to be told as such.
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

void check(const Experiment& experiment, const std::string& channel, const Moments& m, double noise) {
  const double measured = std::sqrt(std::max(0.0, m.measured_square / m.rows - std::pow(m.measured / m.rows, 2)));
  const double model = std::sqrt(std::max(0.0, m.model_square / m.rows - std::pow(m.model / m.rows, 2)));
  if (std::max(measured, model) < kLeastMotion * noise || std::min(measured, model) < kLeastTrace * noise) {
    return;
  }
  const double correlation = (m.product / m.rows - m.measured * m.model / (m.rows * m.rows)) / (measured * model);
  const double ratio = measured / model;
  if (correlation < kRunsAgainst) {
    throw FileError(
        fmt::format("{}: channel {} runs against the declared model (correlation {:.2f}): it looks inverted. Turn its sign "
                    "in the record, or the sign that the model declares; nothing is fitted to it",
                    experiment.name, channel, correlation));
  }
  if (correlation > kFollows && (ratio > kLargestRatio || ratio < 1.0 / kLargestRatio)) {
    throw FileError(
        fmt::format("{}: channel {} follows the declared model at {:.4g} times its size (correlation {:.3f}): it looks "
                    "mis-scaled{}. Mend its unit in the record's first line, or its calibration; nothing is fitted to it",
                    experiment.name, channel, ratio, correlation, unit_hint(ratio)));
  }
}

}  // namespace

void refuse_impossible_channels(const Dataset& data, const Prediction& prediction) {
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (!data.experiments[e].measured[c].empty()) {
        check(data.experiments[e], data.channels[c], moments(data.experiments[e], prediction[e][c], c), data.noise[c]);
      }
    }
  }
}

}  // namespace hotfire::explain
