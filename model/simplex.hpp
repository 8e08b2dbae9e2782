// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "model/actuator/axis.hpp"
#include "model/effects.hpp"

namespace hotfire::model {

/// One axis alone, physics.md section 1: `Axis` on the spring of its own attach point. Discretisation, cost and order as
/// said there.
template <class S, class List = SimplexEffects>
class Simplex : public Axis<S, List> {
 public:
  using typename Axis<S, List>::Advance;
  using typename Axis<S, List>::State;
  using Axis<S, List>::Axis;
  static constexpr std::string_view topology = "simplex";
  static constexpr int kPasses = 2;

  /// The steady state under a constant command [rad]: set-up only.
  State steady(const S& command) const { return this->settled(command, Uncoupled{}); }

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
  void step(State& state, const S& command) const noexcept {
    step(state, command, [](const S&) { return Uncoupled{}; });
  }

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

}  // namespace hotfire::model
