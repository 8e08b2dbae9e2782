// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "tools/files/text/units.hpp"

namespace hotfire::explain {

namespace {

Scales scales_of_records(const Dataset& data) {
  double force = 0.0;
  double size = 0.0;         // of what is measured
  double rate = 0.0;         // of what is measured
  std::ptrdiff_t order = 0;  // of the derivative of the position that the first record measures
  double rows = 0.0;
  for (const Experiment& experiment : data.experiments) {
    const auto measured =
        std::ranges::find_if(experiment.measured, [](const std::vector<double>& values) { return !values.empty(); });
    const std::ptrdiff_t own_order = measured - experiment.measured.begin();
    if (measured == experiment.measured.end() || (rows > 0.0 && own_order != order)) {
      continue;
    }
    order = own_order;
    const std::vector<double>& x = *measured;
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    // A speed over a tenth of a second, or over the record if that is shorter: differences of neighbours are noise.
    const std::size_t apart = std::clamp<std::size_t>(static_cast<std::size_t>(0.002 / experiment.period), 1,
                                                      std::max<std::size_t>(1, x.size() / 2));
    for (std::size_t row = 0; row < x.size(); ++row) {
      force += experiment.input[row] * experiment.input[row];
      size += (x[row] - mean) * (x[row] - mean);
      if (row >= apart) {
        const double v = (x[row] - x[row - apart]) / (static_cast<double>(apart) * experiment.period);
        rate += v * v;
      }
    }
    rows += static_cast<double>(x.size());
  }
  Scales scales;
  if (rows > 0.0 && force > 0.0 && size > 0.0 && rate > 0.0) {
    scales.force = std::sqrt(force / rows);
    scales.time = std::sqrt(size / rate);
    scales.position = std::sqrt(size / rows) * std::pow(scales.time, static_cast<double>(order));
  }
  return scales;
}

Scales scales_of_rig(const SimplexParameters& declared) {
  const SimplexParameters reference;
  Scales scales;
  scales.metre = reference.servovalve.position_gain / declared.servovalve.position_gain;
  scales.second = servo_time(declared) / servo_time(reference);
  scales.pascal = declared.actuator.supply_pressure / reference.actuator.supply_pressure;
  return scales;
}

}  // namespace

Scales scales_of(const ModelParameters& declared, const Dataset& data) {
  const auto* axis = std::get_if<SimplexParameters>(&declared);
  return axis != nullptr ? scales_of_rig(*axis) : scales_of_records(data);
}

double servo_time(const SimplexParameters& declared) {
  return declared.actuator.piston_area / (declared.servovalve.rated_flow * declared.servovalve.position_gain);
}

double size_of_unit(std::string_view unit, const Scales& scales) {
  const double newton = scales.pascal * scales.metre * scales.metre;
  const std::array<std::pair<std::string_view, double>, 10> sizes{
      {{"force", scales.force},
       {"position", scales.position},
       {"time", scales.time},
       {"m", scales.metre},
       {"s", scales.second},
       {"Hz", 1.0 / scales.second},
       {"Pa", scales.pascal},
       {"N", newton},
       {"kg", newton * scales.second * scales.second / scales.metre},
       {"rad", 1.0}}};
  return unit_product(
             unit,
             [&](std::string_view word) -> std::optional<double> {
               const auto found = std::ranges::find(sizes, word, [](const auto& size) { return size.first; });
               return found != sizes.end() ? std::optional(found->second) : word == "1" ? std::optional(1.0) : std::nullopt;
             })
      .value_or(1.0);
}

}  // namespace hotfire::explain
