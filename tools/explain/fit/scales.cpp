// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/scales.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hotfire::explain {

Scales scales_of(const Dataset& data) {
  double force = 0.0;
  double position = 0.0;
  double velocity = 0.0;
  double rows = 0.0;
  for (const Experiment& experiment : data.experiments) {
    const auto& x = experiment.measured.front();
    if (x.empty()) {
      continue;
    }
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    // A speed over a tenth of a second, or over the record if that is shorter: differences of neighbours are noise.
    const std::size_t apart = std::clamp<std::size_t>(static_cast<std::size_t>(0.002 / experiment.period), 1,
                                                      std::max<std::size_t>(1, x.size() / 2));
    for (std::size_t row = 0; row < x.size(); ++row) {
      force += experiment.input[row] * experiment.input[row];
      position += (x[row] - mean) * (x[row] - mean);
      if (row >= apart) {
        const double v = (x[row] - x[row - apart]) / (static_cast<double>(apart) * experiment.period);
        velocity += v * v;
      }
    }
    rows += static_cast<double>(x.size());
  }
  Scales scales;
  if (rows > 0.0 && force > 0.0 && position > 0.0 && velocity > 0.0) {
    scales.force = std::sqrt(force / rows);
    scales.position = std::sqrt(position / rows);
    scales.time = std::sqrt(position / velocity);
  }
  return scales;
}

double size_of_unit(std::string_view unit, const Scales& scales) {
  double size = 1.0;
  double direction = 1.0;
  while (!unit.empty()) {
    const std::size_t end = std::min(unit.find_first_of("./"), unit.size());
    std::string_view word = unit.substr(0, end);
    double exponent = 1.0;
    if (const std::size_t hat = word.find('^'); hat != std::string_view::npos) {
      exponent = static_cast<double>(word[hat + 1] - '0');
      word = word.substr(0, hat);
    }
    double base = 0.0;
    if (word == "force") {
      base = scales.force;
    } else if (word == "position") {
      base = scales.position;
    } else if (word == "time") {
      base = scales.time;
    } else {
      return 1.0;
    }
    size *= std::pow(base, direction * exponent);
    if (end == unit.size()) {
      break;
    }
    direction = unit[end] == '/' ? -1.0 : 1.0;
    unit.remove_prefix(end + 1);
  }
  return size;
}

}  // namespace hotfire::explain
