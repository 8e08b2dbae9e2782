// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "model/actuator/axis.hpp"
#include "model/effects.hpp"
#include "model/numerics/step_size.hpp"

namespace hotfire::model {

/// One axis alone, physics.md section 1: `Axis` on the spring of its own attach point. Discretisation, cost and order as
/// said there.
template <class S, class List = SimplexEffects>
class Simplex : public Axis<S, List> {
 public:
  using typename Axis<S, List>::Advance;
  using typename Axis<S, List>::State;
  static constexpr std::string_view topology = "simplex";
  static constexpr int kPasses = 2;

  /// Constants of a run at step `h` [s].
  Simplex(const typename Axis<S, List>::Parameters& parameters, double h);

  /// The longest step [s] at these parameters: a fifth of a cycle of the piston on its oil and its load spring, 365 Hz on
  /// the reference axis. What is not linear is held over a step.
  static double longest_step(const typename Axis<S, List>::Parameters& parameters) noexcept {
    constexpr double kStepsInCycle = 5.0;
    const auto& actuator = parameters.actuator;
    const double area = value_of(actuator.piston_area);
    const double oil = 4.0 * value_of(actuator.bulk_modulus) * area * area / value_of(actuator.trapped_volume);
    const double spring = 1.0 / (1.0 / value_of(actuator.stiffness) + 1.0 / value_of(parameters.structure.stiffness));
    const double cycle = 2.0 * std::numbers::pi * std::sqrt(value_of(actuator.piston_mass) / (oil + spring));
    return std::clamp(cycle / kStepsInCycle, kShortestStep, kLongestStep);
  }

  /// The steady state under a constant command [rad]: set-up only.
  State steady(const S& command) const;

  /// The same of an axis whose piston was seen at `piston` [m], if it was: it rests there without position feedback, and as
  /// far as a play in the valve lets it.
  State resting(const S& command, const std::optional<double>& piston) const {
    return this->settled(command, Uncoupled{}, piston);
  }

  /// The same beside another axis, whose motion is given: `around(angle)` is the `Coupling` at the axis's own angle [rad].
  template <class Around>
  State steady(const S& command, const Around& around) const {
    constexpr int kRounds = 12;  // each shrinks the change by that of the arms, 1e-1
    S angle = command;
    State state;
    for (int round = 0; round < kRounds; ++round) {
      state = this->settled(command, around(angle));
      const double change = value_of(state.y(this->kAngle) - angle);
      angle = state.y(this->kAngle);
      if (std::abs(change) < 1e-13) {
        break;
      }
    }
    return state;
  }

  /// Advances by one step with the command [rad] held.
  void step(State& state, const S& command) const noexcept;

  /// The same beside another axis: `around(angle)` is the `Coupling` over the step at the axis's own mean angle.
  template <class Around>
  void step(State& state, const S& command, const Around& around) const noexcept {
    Advance advance;
    this->begin(state, command, advance);
    for (int pass = 0; pass < kPasses; ++pass) {
      this->predict(state, advance);
      this->evaluate(state, advance, around(advance.mean(this->kAngle)), pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    this->finish(state, advance);
  }
};

template <class S, class List>
Simplex<S, List>::Simplex(const typename Axis<S, List>::Parameters& parameters, double h) : Axis<S, List>(parameters, h) {}

template <class S, class List>
typename Simplex<S, List>::State Simplex<S, List>::steady(const S& command) const {
  return this->settled(command, Uncoupled{});
}

template <class S, class List>
void Simplex<S, List>::step(State& state, const S& command) const noexcept {
  step(state, command, [](const S&) { return Uncoupled{}; });
}

#ifdef HOTFIRE_COMPILED_PLANTS
extern template class Simplex<double>;
#endif

}  // namespace hotfire::model
