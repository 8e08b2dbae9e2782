// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "model/actuator/parts.hpp"
#include "model/effects.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/exact_hold.hpp"
#include "model/numerics/interpolation.hpp"
#include "model/numerics/step_size.hpp"

namespace hotfire::model {

/// A mass driven by a measured force: inertia x'' + damping x' + stiffness x = drive(force) - effects. The modal hammer test
/// of [SD] eq. 8, a bench mass, an electromechanical stage, a motor with a tachometer. Units are whatever consistent set the
/// record has.
///
/// Discretised as `Simplex` is: exact hold of the linear part, effects held at the mean of the step's ends, two passes. The
/// acceleration at the end of a step is that of the equation there: the effects give their force under the motion at the
/// end, and the driving force continues that of the last two steps by half a step. Second order where the motion is smooth.
template <class S, class List = DirectEffects>
class Direct {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view topology = "direct";
  static constexpr std::string_view input_channel = "force";
  enum Channel { kPosition, kVelocity, kAcceleration };
  static constexpr std::array<std::string_view, 3> channels{"position", "velocity", "acceleration"};
  static constexpr std::array<std::string_view, 3> channel_units{"", "", ""};
  static constexpr std::string_view input_unit = "";
  static constexpr int kPasses = 2;

  struct Parameters {
    Mass<S> mass;
    EffectParameters<S, List> effects;

    template <class Self, class F>
    static constexpr void for_each_part(Self& self, F&& f) {
      f(self.mass);
    }
  };

  struct State {
    Eigen::Matrix<S, 2, 1> y = Eigen::Matrix<S, 2, 1>::Zero();  ///< position, velocity
    Eigen::Matrix<S, 2, 1> inputs = Eigen::Matrix<S, 2, 1>::Zero();
    Clock<S> clock{};  ///< time of the record, for effects that depend on it
    EffectStates<S, List> effects{};
    S force{0.0};         ///< of the drive, over the last step
    S force_before{0.0};  ///< over the step before it
    std::array<S, 3> measured{};
  };

  /// The longest step [s] at these parameters: a tenth of a radian of the mass's own oscillation. Nonlinear terms are held
  /// over a step. The error of this is a 24th of the square of that angle: 0.04 %. A mass without a spring moves slowly.
  static double longest_step(const Parameters& parameters) noexcept {
    constexpr double kAngle = 0.1;
    const double stiffness = value_of(parameters.mass.stiffness);
    if (!(stiffness > 0.0)) {
      return kLongestStep;
    }
    return std::clamp(kAngle * std::sqrt(value_of(parameters.mass.inertia) / stiffness), kShortestStep, kLongestStep);
  }

  Direct(const Parameters& parameters, double h) : parameters_(parameters), acting_(parameters.effects.active), h_(h) {
    Eigen::Matrix<S, 2, 2> linear = Eigen::Matrix<S, 2, 2>::Zero();
    linear(0, 1) = S{1.0};
    linear(1, 0) = -parameters_.mass.stiffness / parameters_.mass.inertia;
    linear(1, 1) = -parameters_.mass.damping / parameters_.mass.inertia;
    Eigen::Matrix<S, 2, 2> driven = Eigen::Matrix<S, 2, 2>::Zero();
    driven(1, 0) = 1.0 / parameters_.mass.inertia;
    driven(1, 1) = -1.0 / parameters_.mass.inertia;
    hold_ = exact_hold<S, 2, 2>(linear, driven, h);
    compliance_ = -hold_.response(0, 1) / h;
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// At rest at a position.
  State at_rest(const S& position) const { return moving(position, S{0.0}); }

  /// At a position with a velocity, under a force.
  State moving(const S& position, const S& velocity, const S& force = S{0.0}) const {
    State state;
    state.y(0) = position;
    state.y(1) = velocity;
    Signal<S> drive{force, h_};
    settle<Site::command>(parameters_.effects, state.effects, drive);
    pass_through<Site::command>(parameters_.effects, acting_, state.effects, drive, Keep::no);
    state.force = state.force_before = drive.value;
    read(state);
    return state;
  }

  /// Advances by one step with the force held, and reads.
  void step(State& state, const S& force) const noexcept {
    step_unread(state, force);
    read(state);
  }

  /// The same without the readings, for a step that nobody reads at.
  void step_unread(State& state, const S& force) const noexcept {
    Signal<S> drive{force, h_, state.clock.at(h_, 0.5)};
    pass_through<Site::command>(parameters_.effects, acting_, state.effects, drive, Keep::yes);
    state.force_before = state.force;
    state.force = drive.value;
    state.inputs(0) = drive.value;
    const Eigen::Matrix<S, 2, 1> start = state.y;
    const Eigen::Matrix<S, 2, 1> free = times(hold_.transition, start);
    for (int pass = 0; pass < kPasses; ++pass) {
      const Eigen::Matrix<S, 2, 1> end = free + times(hold_.response, state.inputs);
      const S velocity = (end(0) - start(0)) / h_;
      Motion<S> motion = motion_of(S(0.5) * (start(0) + end(0)), velocity, h_, state.clock.at(h_, 0.5));
      state.inputs(1) = sum_over<Site::mass_force>(parameters_.effects, acting_, state.effects, motion,
                                                   pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    state.y = free + times(hold_.response, state.inputs);
    state.clock.steps += 1.0;
  }

  static const std::array<S, 3>& measured(const State& state) noexcept { return state.measured; }

 private:
  Motion<S> motion_of(const S& position, const S& velocity, double h, const Precise<S>& time) const noexcept {
    Motion<S> motion{position, velocity, velocity, compliance_, h, time};
    motion.declared_stiffness = parameters_.mass.stiffness;
    motion.declared_damping = parameters_.mass.damping;
    return motion;
  }

  void read(State& state) const noexcept {
    const S& position = state.y(0);
    const S& velocity = state.y(1);
    // Dry friction jumps within a step where the motion turns: the mean over the step is not the force at its end.
    const S acceleration = (end_of_step(state.force, state.force_before) - parameters_.mass.damping * velocity -
                            parameters_.mass.stiffness * position) /
                           parameters_.mass.inertia;
    Motion<S> body = motion_of(position, velocity, h_, state.clock.at(h_, 0.0));
    body.compliance = 1.0 / parameters_.mass.inertia;
    const S against = sum_at_end<Site::mass_force>(parameters_.effects, acting_, state.effects, body, acceleration);
    state.measured = {position, velocity, S(acceleration - against / parameters_.mass.inertia)};
  }

  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
  ExactHold<S, 2, 2> hold_;
  S compliance_{0.0};
};

}  // namespace hotfire::model
