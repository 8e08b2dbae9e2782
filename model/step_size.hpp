#pragma once

namespace hotfire::model {

/// The longest step the model is integrated with [s]. A sampling period or a real-time period longer than this is split into
/// equal parts: 0.5 ms puts 5 steps into a cycle of the reference oil mode (365 Hz).
inline constexpr double kLongestStep = 5e-4;

/// Into how many equal steps a period [s] is split, at least one. A period that is a multiple of the longest step up to
/// rounding is split into that multiple.
constexpr int steps_per_period(double period) noexcept {
  const double parts = period / kLongestStep;
  const int whole = static_cast<int>(parts);
  const int steps = parts - whole > 1e-9 * parts ? whole + 1 : whole;
  return steps > 1 ? steps : 1;
}

}  // namespace hotfire::model
