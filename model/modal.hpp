// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <tuple>

#include "model/effects.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/exact_hold.hpp"
#include "model/numerics/interpolation.hpp"
#include "model/numerics/step_size.hpp"
#include "model/structure/rig_mode.hpp"

namespace hotfire::model {

/// A structure in modal coordinates that a measured force drives at one place and a joint of unknown law crosses; its motion
/// is read at three places. An airframe on a shaker. Units are whatever consistent set the record has.
///
///     q_k'' + 2 zeta_k w_k q_k' + w_k^2 q_k = mobility_k (drive_k force - joint_k effects)
///     place 1: sum q_k,   place p: sum place_pk q_k,   joint: sum joint_k q_k
///
/// The effects depend on the motion across the joint. Each mode is advanced by its exact hold, with the effects held at the
/// mean of the step's ends, in two passes. The acceleration at the end of a step is that of the equation there: the effects
/// give their force under the motion at the end, and the driving force continues that of the last two steps by half a step.
/// Second order where the motion is smooth.
template <class S, class List = JointEffects>
class Modal {
 public:
  using Scalar = S;
  using Effects = List;
  static constexpr std::string_view topology = "modal";
  static constexpr std::string_view input_channel = "force";
  static constexpr std::array<std::string_view, 9> channels{"position",  "velocity",  "acceleration",
                                                            "position2", "velocity2", "acceleration2",
                                                            "position3", "velocity3", "acceleration3"};
  static constexpr std::array<std::string_view, 9> channel_units{"", "", "", "", "", "", "", "", ""};
  static constexpr std::string_view input_unit = "";
  static constexpr int kPasses = 2;
  static constexpr std::size_t kPlaces = 3;

  struct Parameters {
    std::tuple<RigMode<S, 0>, RigMode<S, 1>, RigMode<S, 2>, RigMode<S, 3>, RigMode<S, 4>, RigMode<S, 5>> modes;
    EffectParameters<S, List> effects;

    template <class Self, class F>
    static constexpr void for_each_part(Self& self, F&& f) {
      std::apply([&](auto&... mode) { (f(mode), ...); }, self.modes);
    }
  };

  struct State {
    Eigen::Matrix<S, 2 * kRigModes, 1> y = Eigen::Matrix<S, 2 * kRigModes, 1>::Zero();  ///< of every mode: q, q'
    S joint_force{0.0};
    Clock<S> clock{};  ///< time of the record, for effects that depend on it
    EffectStates<S, List> effects{};
    S force{0.0};         ///< over the last step
    S force_before{0.0};  ///< over the step before it
    std::array<S, 9> measured{};
  };

  /// The longest step [s] at these parameters: a tenth of a radian of the fastest mode, as of a `Direct` mass.
  static double longest_step(const Parameters& parameters) noexcept {
    constexpr double kAngle = 0.1;
    double fastest = 0.0;
    Parameters::for_each_part(parameters, [&](const auto& mode) {
      fastest = value_of(mode.mobility) > 0.0 ? std::max(fastest, value_of(mode.frequency)) : fastest;
    });
    return fastest > 0.0 ? std::clamp(kAngle / (2.0 * std::numbers::pi * fastest), kShortestStep, kLongestStep)
                         : kLongestStep;
  }

  Modal(const Parameters& parameters, double h) : parameters_(parameters), acting_(parameters.effects.active), h_(h) {
    Eigen::Index q = 0;
    Parameters::for_each_part(parameters_, [&](const auto& mode) {
      const Eigen::Index own = q;
      q += 2;
      if (!(value_of(mode.mobility) > 0.0)) {
        return;
      }
      const S w = 2.0 * std::numbers::pi * mode.frequency;
      Eigen::Matrix<S, 2, 2> linear = Eigen::Matrix<S, 2, 2>::Zero();
      linear(0, 1) = S{1.0};
      linear(1, 0) = -w * w;
      linear(1, 1) = -2.0 * mode.damping_ratio * w;
      Eigen::Matrix<S, 2, 1> driven = Eigen::Matrix<S, 2, 1>::Zero();
      driven(1) = mode.mobility;
      const auto hold = exact_hold<S, 2, 1>(linear, driven, h);
      modes_[count_++] = {own,
                          hold.transition,
                          {hold.response(0) * mode.drive, hold.response(1) * mode.drive},
                          {hold.response(0) * mode.joint, hold.response(1) * mode.joint},
                          mode.joint,
                          {S{1.0}, mode.place2, mode.place3},
                          linear(1, 0),
                          linear(1, 1),
                          S(mode.mobility * mode.drive),
                          S(mode.mobility * mode.joint)};
      compliance_ += mode.joint * mode.joint * hold.response(0) / h;
    });
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// At rest.
  State at_rest(const S&) const { return {}; }

  /// Advances by one step with the force held, and reads.
  void step(State& state, const S& force) const noexcept {
    step_unread(state, force);
    read(state);
  }

  /// The same without the readings, which cost more than the step: for a step that nobody reads at.
  void step_unread(State& state, const S& force) const noexcept {
    state.force_before = state.force;
    state.force = force;
    const Eigen::Matrix<S, 2 * kRigModes, 1> start = state.y;
    Eigen::Matrix<S, 2 * kRigModes, 1> free;
    S before{0.0};
    S free_end{0.0};
    for (const Mode& mode : modes()) {
      for (Eigen::Index i = 0; i < 2; ++i) {
        free(mode.q + i) =
            mode.transition(i, 0) * start(mode.q) + mode.transition(i, 1) * start(mode.q + 1) + mode.driven(i) * force;
      }
      before += mode.joint * start(mode.q);
      free_end += mode.joint * free(mode.q);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
      const S end = free_end - compliance_ * h_ * state.joint_force;
      const S velocity = (end - before) / h_;
      Motion<S> motion{S(0.5) * (before + end), velocity, velocity, compliance_, h_, state.clock.at(h_, 0.5)};
      state.joint_force = sum_over<Site::mass_force>(parameters_.effects, acting_, state.effects, motion,
                                                     pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    for (const Mode& mode : modes()) {
      for (Eigen::Index i = 0; i < 2; ++i) {
        state.y(mode.q + i) = free(mode.q + i) - mode.joined(i) * state.joint_force;
      }
    }
    state.clock.steps += 1.0;
  }

  /// Motion across the joint, and its rate.
  S joint_position(const State& state) const noexcept { return across_joint(state, 0); }
  S joint_rate(const State& state) const noexcept { return across_joint(state, 1); }

  static const std::array<S, 9>& measured(const State& state) noexcept { return state.measured; }

 private:
  struct Mode {
    Eigen::Index q = 0;  ///< of its coordinate in a state; its rate is the next one
    Eigen::Matrix<S, 2, 2> transition{};
    Eigen::Matrix<S, 2, 1> driven{};  ///< what a unit of the force adds over a step
    Eigen::Matrix<S, 2, 1> joined{};  ///< what a unit of the joint's force takes away
    S joint{0.0};
    std::array<S, kPlaces> shape{};
    S stiffness{0.0};  ///< with the next three: acceleration for a unit of position, velocity, force and the joint's force
    S damping{0.0};
    S driven_by{0.0};
    S joined_by{0.0};
  };

  /// The modes that are there.
  std::span<const Mode> modes() const noexcept { return std::span(modes_).first(count_); }

  S across_joint(const State& state, Eigen::Index derivative) const noexcept {
    S sum{0.0};
    for (const Mode& mode : modes()) {
      sum += mode.joint * state.y(mode.q + derivative);
    }
    return sum;
  }

  void read(State& state) const noexcept {
    const S force = end_of_step(state.force, state.force_before);
    // Dry friction jumps within a step where the motion turns: the mean over the step is not the force at its end.
    S across{0.0};
    S mobility{0.0};
    for (const Mode& mode : modes()) {
      across +=
          mode.joint * (mode.stiffness * state.y(mode.q) + mode.damping * state.y(mode.q + 1) + mode.driven_by * force);
      mobility += mode.joint * mode.joined_by;
    }
    const S rate = joint_rate(state);
    const Motion<S> joint{joint_position(state), rate, rate, mobility, h_, state.clock.at(h_, 0.0)};
    const S joint_force = sum_at_end<Site::mass_force>(parameters_.effects, acting_, state.effects, joint, across);
    state.measured.fill(S{0.0});
    for (const Mode& mode : modes()) {
      const S& position = state.y(mode.q);
      const S& velocity = state.y(mode.q + 1);
      const S acceleration =
          mode.stiffness * position + mode.damping * velocity + mode.driven_by * force - mode.joined_by * joint_force;
      for (std::size_t place = 0; place < kPlaces; ++place) {
        state.measured[3 * place] += mode.shape[place] * position;
        state.measured[3 * place + 1] += mode.shape[place] * velocity;
        state.measured[3 * place + 2] += mode.shape[place] * acceleration;
      }
    }
  }

  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
  std::array<Mode, kRigModes> modes_{};
  std::size_t count_ = 0;
  S compliance_{0.0};
};

}  // namespace hotfire::model
