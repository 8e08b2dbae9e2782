// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string_view>

#include "model/actuator/parts.hpp"
#include "model/effects.hpp"
#include "model/numerics/clock.hpp"

namespace hotfire::model {

/// A body that a stiff drive moves along a given path, and the force that this takes: force = inertia x'' + damping x' +
/// stiffness x + effects. A damper, a mount, a seal or a bearing on a shaker. Units are whatever consistent set the record
/// has.
///
/// The path is known at the ends of the steps. Damping, stiffness and effects are evaluated at the mean of a step's ends,
/// the acceleration is the second difference. The reading after a step is the force at its start, because an acceleration
/// there needs the position after it: second order in time where the motion is smooth. A rig therefore reads the force one
/// step late.
template <class S, class List = ImposedMotionEffects>
class ImposedMotion {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view topology = "imposed_motion";
  static constexpr std::string_view input_channel = "position";
  static constexpr std::array<std::string_view, 1> channels{"force"};
  static constexpr std::array<std::string_view, 1> channel_units{""};
  static constexpr std::string_view input_unit = "";

  struct Parameters {
    MovedBody<S> body;
    EffectParameters<S, List> effects;

    template <class Self, class F>
    static constexpr void for_each_part(Self& self, F&& f) {
      f(self.body);
    }
  };

  struct State {
    Eigen::Matrix<S, 2, 1> y = Eigen::Matrix<S, 2, 1>::Zero();  ///< position, mean velocity over the last step
    S carried{0.0};                                             ///< force of all but the inertia, mean over the last step
    Clock<S> clock{};                                           ///< time of the record, for effects that depend on it
    EffectStates<S, List> effects{};
    std::array<S, 1> measured{};
  };

  /// Who moves the body chooses the steps: a longer period cannot be split without a position between its ends.
  static double longest_step(const Parameters&) noexcept { return std::numeric_limits<double>::infinity(); }

  ImposedMotion(const Parameters& parameters, double h)
      : parameters_(parameters), acting_(parameters.effects.active), h_(h) {}

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// At rest at a position.
  State at_rest(const S& position) const {
    State state;
    state.y(0) = position;
    state.carried = parameters_.body.stiffness * position;
    state.measured[0] = state.carried;
    return state;
  }

  /// Advances by one step that ends at `position`.
  void step(State& state, const S& position) const noexcept {
    const S velocity = (position - state.y(0)) / h_;
    Motion<S> motion{S(0.5) * (state.y(0) + position), velocity, velocity, S{0.0}, h_, state.clock.at(h_, 0.5)};
    motion.declared_stiffness = parameters_.body.stiffness;
    motion.declared_damping = parameters_.body.damping;
    const S carried = parameters_.body.damping * velocity + parameters_.body.stiffness * motion.position +
                      sum_over<Site::mass_force>(parameters_.effects, acting_, state.effects, motion, Keep::yes);
    const S acceleration = (velocity - state.y(1)) / h_;
    state.measured[0] = parameters_.body.inertia * acceleration + 0.5 * (state.carried + carried);
    state.y(0) = position;
    state.y(1) = velocity;
    state.carried = carried;
    state.clock.steps += 1.0;
  }

  static const std::array<S, 1>& measured(const State& state) noexcept { return state.measured; }

 private:
  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
};

}  // namespace hotfire::model
