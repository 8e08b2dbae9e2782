// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/common_bias.hpp"

#include "tools/explain/inference/zero_shift.hpp"

namespace hotfire::explain {

namespace {

constexpr double kLeft = 0.1;
constexpr std::size_t kFewestRecords = 2;

bool has_valve_bias(const SimplexParameters& parameters) {
  bool has = false;
  model::visit_effects(parameters, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (std::is_same_v<E, model::ValveBias>) {
      has = parameters.effects.active[index];
    }
  });
  return has;
}

}  // namespace

SimplexParameters with_valve_bias(SimplexParameters parameters, double bias) {
  model::visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (std::is_same_v<E, model::ValveBias>) {
      parameters.effects.active[index] = true;
      values.bias = bias;
    }
  });
  return parameters;
}

std::optional<double> common_valve_bias(const Dataset& data, const Zeros& zeros, const SimplexParameters& parameters) {
  // Without position feedback a bias of the valve is a drift and not a zero.
  const bool has_feedback = parameters.servovalve.position_feedback > 0.0;
  if (!has_feedback || data.experiments.size() < kFewestRecords || has_valve_bias(parameters)) {
    return std::nullopt;
  }
  constexpr double kSmall = 0.01;
  const double step = data.experiments.front().period;
  const CommonShift common =
      common_shift(data, zeros, shift_at_rest(parameters, with_valve_bias(parameters, kSmall), kSmall, step));
  return common.shows && common.left < kLeft * kLeft * common.whole ? common.amount : std::nullopt;
}

}  // namespace hotfire::explain
