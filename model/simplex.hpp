#pragma once

#include <string_view>

#include "model/axis.hpp"
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

  /// Advances by one step with the command [rad] held.
  void step(State& state, const S& command) const noexcept {
    Advance advance;
    this->begin(state, command, advance);
    for (int pass = 0; pass < kPasses; ++pass) {
      this->predict(state, advance);
      this->evaluate(state, advance, Uncoupled{}, pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    this->finish(state, advance);
  }
};

}  // namespace hotfire::model
