// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hotfire::model {

/// The longest step the model is integrated with [s]. A sampling period or a real-time period longer than this is split into
/// equal parts: 0.5 ms puts 5 steps into a cycle of the reference oil mode (365 Hz).
inline constexpr double kLongestStep = 5e-4;

/// The shortest step that parameters can ask for [s]: bounds the steps of a real-time period.
inline constexpr double kShortestStep = 5e-6;

/// Number of equal steps of at most `longest` [s] in a period [s], at least one. A period that is a multiple of the longest
/// step up to rounding is split into that multiple.
constexpr int steps_per_period(double period, double longest = kLongestStep) noexcept {
  const double parts = period / longest;
  const int whole = static_cast<int>(parts);
  const int steps = parts - whole > 1e-9 * parts ? whole + 1 : whole;
  return steps > 1 ? steps : 1;
}

/// The same for a plant whose longest step depends on its parameters.
template <class Plant>
int steps_per_period(const typename Plant::Parameters& parameters, double period) noexcept {
  if constexpr (requires { Plant::longest_step(parameters); }) {
    return steps_per_period(period, Plant::longest_step(parameters));
  } else {
    return steps_per_period(period);
  }
}

}  // namespace hotfire::model
