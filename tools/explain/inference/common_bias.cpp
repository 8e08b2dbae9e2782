// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/common_bias.hpp"

#include <array>
#include <cmath>

namespace hotfire::explain {

namespace {

constexpr double kLeft = 0.1;
constexpr std::size_t kFewestRecords = 2;

bool has_valve_bias(const PlainParameters<SimplexFamily>& parameters) {
  bool has = false;
  model::visit_effects(parameters, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (std::is_same_v<E, model::ValveBias>) {
      has = parameters.effects.active[index];
    }
  });
  return has;
}

/// What a unit of bias adds to each reading of an axis at rest.
std::array<double, 3> shift_by_bias(const PlainParameters<SimplexFamily>& parameters, double step) {
  constexpr double kSmall = 0.01;
  const model::Simplex<double> plain(parameters, step);
  const model::Simplex<double> biased(with_valve_bias(parameters, kSmall), step);
  const std::array<double, 3> before = plain.measured(plain.steady(0.0));
  std::array<double, 3> shift = biased.measured(biased.steady(0.0));
  for (std::size_t c = 0; c < shift.size(); ++c) {
    shift[c] = (shift[c] - before[c]) / kSmall;
  }
  return shift;
}

}  // namespace

PlainParameters<SimplexFamily> with_valve_bias(PlainParameters<SimplexFamily> parameters, double bias) {
  model::visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (std::is_same_v<E, model::ValveBias>) {
      parameters.effects.active[index] = true;
      values.bias = bias;
    }
  });
  return parameters;
}

std::optional<double> common_valve_bias(const Dataset& data, const Zeros& zeros,
                                        const PlainParameters<SimplexFamily>& parameters) {
  if (data.experiments.size() < kFewestRecords || has_valve_bias(parameters)) {
    return std::nullopt;
  }
  const std::array<double, 3> shift = shift_by_bias(parameters, data.experiments.front().period);
  double product = 0.0;
  double square = 0.0;
  double whole = 0.0;
  bool shows = false;
  // Over the deviation of each channel's zero: as the zeros' prior weighs them.
  for (std::size_t e = 0; e < zeros.size(); ++e) {
    for (std::size_t c = 0; c < shift.size(); ++c) {
      const Experiment& experiment = data.experiments[e];
      if (experiment.measured[c].empty() || !(experiment.zero_deviation[c] > 0.0)) {
        continue;
      }
      const double zero = zeros[e][c] / experiment.zero_deviation[c];
      const double of_bias = shift[c] / experiment.zero_deviation[c];
      product += of_bias * zero;
      square += of_bias * of_bias;
      whole += zero * zero;
      shows = shows || std::abs(zeros[e][c]) > experiment.noise[c];
    }
  }
  if (!shows || !(square > 0.0)) {
    return std::nullopt;
  }
  const double left = whole - product * product / square;
  return left < kLeft * kLeft * whole ? std::optional(product / square) : std::nullopt;
}

}  // namespace hotfire::explain
