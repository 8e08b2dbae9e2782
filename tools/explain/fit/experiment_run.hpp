// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>

#include "tools/explain/data/dataset.hpp"
#include "tools/explain/fit/axis_in_vehicle.hpp"
#include "tools/explain/fit/parameter_space.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire::explain {

/// Where an experiment starts, as far as its first command does not say.
template <class S>
struct Start {
  std::array<S, 3> values{S(0.0), S(0.0), S(0.0)};  ///< position, velocity, clock: FreeParameter::state
};

template <class Plant, class S>
typename Plant::State initial_state(const Plant& plant, const Dataset& data, const Experiment& experiment,
                                    const Start<S>& start) {
  if constexpr (Plant::topology == "imposed_motion") {
    return enter_path(plant, experiment.input, experiment.period, experiment.start);
  } else {
    typename Plant::State state = [&] {
      if constexpr (Plant::topology == "direct") {
        return plant.moving(start.values[0], start.values[1], S(experiment.input.front()));
      } else if constexpr (Plant::topology == "modal") {
        return plant.at_rest(S(0.0));
      } else if constexpr (Plant::topology == "electromechanical") {
        return at_first_row(plant, experiment.input.front(), experiment.measured[Plant::kPosition],
                            experiment.measured[Plant::kMotorPosition]);
      } else if (experiment.other.is_there()) {
        const Beside<S> beside(data.geometry, plant.parameters().actuator.moment_arm);
        const OtherAxis& other = experiment.other;
        const RestOfVehicle& vehicle = experiment.vehicle;
        return plant.steady(S(experiment.input.front()), [&](const S& angle) {
          auto coupling = beside(angle, other.angle.front(), 0.0, other.force.front());
          if (vehicle.is_there()) {
            coupling.motion += vehicle.motion.front();
            coupling.torque += vehicle.torque.front();
          }
          return coupling;
        });
      } else {
        return plant.resting(S(experiment.input.front()),
                             first_piston(plant, experiment.input, experiment.measured[0], experiment.measured[1]));
      }
    }();
    state.clock.start = start.values[2];
    return state;
  }
}

/// Steps a plant through an experiment: a hydraulic axis under the torque that was measured, and if it is one of a vehicle,
/// beside the motion of everything else.
template <class Plant, class Sink>
bool run_experiment(const Plant& plant, const Dataset& data, const Experiment& experiment, typename Plant::State& state,
                    int steps, Sink&& sink) {
  if constexpr (Plant::topology == "simplex") {
    if (experiment.other.is_there()) {
      AxisInVehicle<Plant> axis(plant, data, experiment, state, steps);
      const auto advance = [&](std::size_t row, int k) {
        axis.step(state, typename Plant::Scalar(experiment.input[row]), row, k);
      };
      return run_rows<Plant>(experiment.rows(), state, steps, advance, sink);
    }
    if (!experiment.torque.empty()) {
      return run_under_torque(plant, experiment.input, experiment.torque, state, steps, sink);
    }
  }
  return run(plant, experiment.input, state, steps, sink);
}

/// Constants of a run for every sampling period that occurs.
template <class Plant, class Steps>
std::map<double, std::unique_ptr<Plant>> plants_by_period(const Dataset& data, const typename Plant::Parameters& parameters,
                                                          Steps&& steps) {
  std::map<double, std::unique_ptr<Plant>> plants;
  for (const Experiment& experiment : data.experiments) {
    auto& plant = plants[experiment.period];
    if (!plant) {
      plant = std::make_unique<Plant>(parameters, experiment.period / steps(experiment));
    }
  }
  return plants;
}

/// The start of an experiment: as measured and at rest, or what free parameters say.
template <class S, class Value>
Start<S> start_of(const Dataset& data, std::size_t experiment, std::span<const FreeParameter> free, Value&& value) {
  Start<S> start;
  const auto& first = data.experiments[experiment].measured.front();
  if (!first.empty()) {
    start.values[0] = S(first.front());
  }
  start.values[2] = S(data.experiments[experiment].start);
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k].experiment == static_cast<int>(experiment)) {
      start.values[static_cast<std::size_t>(free[k].state)] = value(k);
    }
  }
  return start;
}

}  // namespace hotfire::explain
