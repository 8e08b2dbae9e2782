// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "hal/arithmetic/denormals.hpp"
#include "model/actuator/axis.hpp"
#include "model/electromechanical.hpp"
#include "model/numerics/scalar.hpp"
#include "tools/simulate/excitation.hpp"

namespace hotfire {

/// A reading beyond this is a simulation that ran away, in any unit.
inline constexpr double kRunaway = 1e12;
inline bool is_runaway(double reading) { return !(std::abs(reading) < kRunaway); }

/// Where the piston of a hydraulic axis is at the first row, by what is measured of `piston` [m] or `engine` [rad]; nothing
/// where neither is. An axis with position feedback is at rest there: the mean of the first rows under an unchanged
/// `command` has less noise than one row.
template <class S>
std::optional<double> first_piston(const model::Axis<S, model::SimplexEffects>& axis, std::span<const double> command,
                                   std::span<const double> piston, std::span<const double> engine) {
  using model::value_of;
  constexpr std::size_t kRowsOfStart = 20;  // a fifth of the noise of one
  const std::span<const double> measured = piston.empty() ? engine : piston;
  if (measured.empty()) {
    return std::nullopt;
  }
  std::size_t rows = 1;
  while (value_of(axis.parameters().servovalve.position_feedback) > 0.0 &&
         rows < std::min({kRowsOfStart, command.size(), measured.size()}) && command[rows] == command.front()) {
    ++rows;
  }
  const double mean = std::accumulate(measured.begin(), measured.begin() + static_cast<std::ptrdiff_t>(rows), 0.0) /
                      static_cast<double>(rows);
  return piston.empty() ? value_of(axis.parameters().actuator.moment_arm) * mean : mean;
}

/// True if the setpoint is a position: then it has the unit of the load's.
inline bool has_position_loop(const model::Electromechanical<double>::Parameters& parameters) {
  return parameters.controller.position_feedback > 0.0;
}

/// An electromechanical actuator at rest under its first setpoint: where its load, or its motor, is measured at the first
/// row, and otherwise where it rests under its setpoint.
template <class S>
typename model::Electromechanical<S>::State at_first_row(const model::Electromechanical<S>& plant, double setpoint,
                                                         std::span<const double> position,
                                                         std::span<const double> motor_position) {
  const S first = !position.empty()         ? S(position.front())
                  : !motor_position.empty() ? S(motor_position.front() / plant.parameters().transmission.ratio)
                                            : plant.resting_position(S(setpoint));
  const S motor(motor_position.empty() ? 0.0 : motor_position.front());
  return plant.resting(S(setpoint), first, motor_position.empty() ? nullptr : &motor);
}

/// Steps a plant through `rows` rows, `steps` plant steps a row by `advance(row, step)`, and hands every row's readings to
/// `sink(row, readings)`: row 0 is the state as given. Denormal numbers are zero, as they are on the rig. Returns false at
/// the first reading that is not finite or ran away.
template <class Plant, class Advance, class Sink>
bool run_rows(std::size_t rows, const typename Plant::State& state, int steps, Advance&& advance, Sink&& sink) {
  using S = typename Plant::Scalar;
  using model::value_of;
  const hal::FlushDenormals flush;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto& readings = Plant::measured(state);
    for (const S& reading : readings) {
      if (is_runaway(value_of(reading))) {
        return false;
      }
    }
    sink(row, readings);
    for (int k = 0; k < steps; ++k) {
      advance(row, k);
    }
  }
  return true;
}

/// Steps a plant through an input; otherwise as above.
template <class Plant, class Sink>
bool run(const Plant& plant, std::span<const double> input, typename Plant::State& state, int steps, Sink&& sink) {
  using S = typename Plant::Scalar;
  const Excitation excitation(input, steps, between_rows<Plant>());
  const auto advance = [&](std::size_t row, int k) {
    const S value(excitation(row, k));
    if constexpr (requires { plant.step_unread(state, value); }) {
      if (k + 1 < steps) {
        plant.step_unread(state, value);
        return;
      }
    }
    plant.step(state, value);
  };
  return run_rows<Plant>(input.size(), state, steps, advance, sink);
}

/// Steps one hydraulic axis through its command while a measured torque [N m] turns its engine towards positive angles,
/// interpolated between rows; otherwise as above.
template <class Plant, class Sink>
bool run_under_torque(const Plant& plant, std::span<const double> input, std::span<const double> torque,
                      typename Plant::State& state, int steps, Sink&& sink) {
  using S = typename Plant::Scalar;
  const Excitation disturbance(torque, steps, Excitation::Between::interpolated);
  const S& arm = plant.parameters().actuator.moment_arm;
  return run_rows<Plant>(
      input.size(), state, steps,
      [&](std::size_t row, int k) {
        const S torque_against = S(-disturbance(row, k));
        plant.step(state, S(input[row]), [&](const S&) { return model::Coupling<S>{S(0.0), arm, torque_against}; });
      },
      sink);
}

/// Steps the axes of a vehicle through their commands, held between rows, from the steady state under the first and the
/// thrust in `inputs`; hands every row's state to `sink(row, state)`. Before every plant step `disturb(row, step, state,
/// inputs)` may change the state and what else is put in. Returns false at the first reading that is not finite or ran away.
template <class Plant, class Disturb, class Sink>
bool run_vehicle(const Plant& plant, const std::array<std::span<const double>, Plant::kAxes>& commands, double start,
                 int steps, typename Plant::Inputs inputs, Disturb&& disturb, Sink&& sink) {
  const auto set_commands = [&](std::size_t row) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      inputs.commands[i] = commands[i][row];
    }
  };
  set_commands(0);
  // A state with delays is hundreds of kilobytes: it lives on the heap.
  const auto state = std::make_unique<typename Plant::State>(plant.steady(inputs.commands, inputs.thrust));
  for (auto& axis : state->axes) {
    axis.clock.start = start;
  }
  return run_rows<Plant>(
      commands.front().size(), *state, steps,
      [&](std::size_t row, int step) {
        set_commands(row);
        disturb(row, step, *state, inputs);
        plant.step(*state, inputs);
      },
      [&](std::size_t row, const auto&) { sink(row, std::as_const(*state)); });
}

/// The same with nothing but the commands.
template <class Plant, class Sink>
bool run_vehicle(const Plant& plant, const std::array<std::span<const double>, Plant::kAxes>& commands, double start,
                 int steps, Sink&& sink) {
  const auto undisturbed = [](std::size_t, int, auto&, auto&) {};
  return run_vehicle(plant, commands, start, steps, {}, undisturbed, sink);
}

}  // namespace hotfire
