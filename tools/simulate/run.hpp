#pragma once

#include <cmath>
#include <span>

#include "model/scalar.hpp"
#include "tools/simulate/excitation.hpp"

namespace hotfire {

/// A reading beyond this is a simulation that ran away, in any unit.
inline constexpr double kRunaway = 1e12;

/// Steps a plant through an input, `steps` plant steps a row, and hands every
/// row's readings to `sink(row, readings)`: row 0 is the state as given.
/// Returns false at the first reading that is not finite or ran away.
template <class Plant, class Sink>
bool run(const Plant& plant, std::span<const double> input, typename Plant::State& state, int steps, Sink&& sink) {
  using S = typename Plant::Scalar;
  const Excitation excitation(input, steps, between_rows<Plant>());
  for (std::size_t row = 0; row < input.size(); ++row) {
    const auto& readings = Plant::measured(state);
    for (const S& reading : readings) {
      if (!(std::abs(model::value_of(reading)) < kRunaway)) {
        return false;
      }
    }
    sink(row, readings);
    for (int k = 0; k < steps; ++k) {
      plant.step(state, S(excitation(row, k)));
    }
  }
  return true;
}

}  // namespace hotfire
