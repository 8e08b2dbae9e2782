// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

#include "model/effects.hpp"
#include "model/numerics/clock.hpp"
#include "model/numerics/exact_hold.hpp"
#include "model/numerics/step_size.hpp"
#include "model/rig_mode.hpp"

namespace hotfire::model {

/// A structure in modal coordinates that a measured force drives at one place and a joint of unknown law crosses; its motion
/// is read at three places. An airframe on a shaker. Units are whatever consistent set the record has.
///
///     q_k'' + 2 zeta_k w_k q_k' + w_k^2 q_k = mobility_k (drive_k force - joint_k effects)
///     place 1: sum q_k,   place p: sum place_pk q_k,   joint: sum joint_k q_k
///
/// The effects depend on the motion across the joint. Each mode is advanced by its exact hold, with the effects held at the
/// mean of the step's ends, in two passes. The acceleration at the end of a step is that of the mean over the last two
/// steps, continued by half a step. Second order where the motion is smooth.
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
    std::array<S, kPlaces> mean_acceleration{};  ///< over the last step
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
    std::size_t k = 0;
    Parameters::for_each_part(parameters_, [&](const auto& mode) {
      const S w = 2.0 * std::numbers::pi * mode.frequency;
      Eigen::Matrix<S, 2, 2> linear = Eigen::Matrix<S, 2, 2>::Zero();
      linear(0, 1) = S{1.0};
      linear(1, 0) = -w * w;
      linear(1, 1) = -2.0 * mode.damping_ratio * w;
      Eigen::Matrix<S, 2, 1> driven = Eigen::Matrix<S, 2, 1>::Zero();
      driven(1) = mode.mobility;
      modes_[k] = {exact_hold<S, 2, 1>(linear, driven, h), mode.drive, mode.joint, {S{1.0}, mode.place2, mode.place3}};
      compliance_ += mode.joint * mode.joint * modes_[k].hold.response(0) / h;
      ++k;
    });
  }

  const Parameters& parameters() const noexcept { return parameters_; }
  double step_size() const noexcept { return h_; }

  /// At rest.
  State at_rest(const S&) const { return {}; }

  /// Advances by one step with the force held.
  void step(State& state, const S& force) const noexcept {
    const Eigen::Matrix<S, 2 * kRigModes, 1> start = state.y;
    Eigen::Matrix<S, 2 * kRigModes, 1> free;
    for (std::size_t k = 0; k < kRigModes; ++k) {
      const Mode& mode = modes_[k];
      const auto q = static_cast<Eigen::Index>(2 * k);
      for (Eigen::Index i = 0; i < 2; ++i) {
        free(q + i) = mode.hold.transition(i, 0) * start(q) + mode.hold.transition(i, 1) * start(q + 1) +
                      mode.hold.response(i) * mode.drive * force;
      }
    }
    const S before = across_joint(start);
    for (int pass = 0; pass < kPasses; ++pass) {
      const S end = across_joint(free) - compliance_ * h_ * state.joint_force;
      const S velocity = (end - before) / h_;
      Motion<S> motion{S(0.5) * (before + end), velocity, velocity, compliance_, h_, state.clock.at(h_, 0.5)};
      state.joint_force = sum_over<Site::mass_force>(parameters_.effects, acting_, state.effects, motion,
                                                     pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    for (std::size_t k = 0; k < kRigModes; ++k) {
      const Mode& mode = modes_[k];
      const auto q = static_cast<Eigen::Index>(2 * k);
      for (Eigen::Index i = 0; i < 2; ++i) {
        state.y(q + i) = free(q + i) - mode.hold.response(i) * mode.joint * state.joint_force;
      }
    }
    state.clock.steps += 1.0;
    measure(state, start);
  }

  /// Motion across the joint, and its rate.
  S joint_position(const State& state) const noexcept { return across_joint(state.y); }
  S joint_rate(const State& state) const noexcept {
    S sum{0.0};
    for (std::size_t k = 0; k < kRigModes; ++k) {
      sum += modes_[k].joint * state.y(static_cast<Eigen::Index>(2 * k + 1));
    }
    return sum;
  }

  static const std::array<S, 9>& measured(const State& state) noexcept { return state.measured; }

 private:
  struct Mode {
    ExactHold<S, 2, 1> hold{};
    S drive{0.0};
    S joint{0.0};
    std::array<S, kPlaces> shape{};
  };

  S across_joint(const Eigen::Matrix<S, 2 * kRigModes, 1>& y) const noexcept {
    S sum{0.0};
    for (std::size_t k = 0; k < kRigModes; ++k) {
      sum += modes_[k].joint * y(static_cast<Eigen::Index>(2 * k));
    }
    return sum;
  }

  void measure(State& state, const Eigen::Matrix<S, 2 * kRigModes, 1>& start) const noexcept {
    for (std::size_t place = 0; place < kPlaces; ++place) {
      S position{0.0};
      S velocity{0.0};
      S change{0.0};
      for (std::size_t k = 0; k < kRigModes; ++k) {
        const S& shape = modes_[k].shape[place];
        const auto q = static_cast<Eigen::Index>(2 * k);
        position += shape * state.y(q);
        velocity += shape * state.y(q + 1);
        change += shape * (state.y(q + 1) - start(q + 1));
      }
      const S acceleration = change / h_;
      state.measured[3 * place] = position;
      state.measured[3 * place + 1] = velocity;
      state.measured[3 * place + 2] = acceleration + 0.5 * (acceleration - state.mean_acceleration[place]);
      state.mean_acceleration[place] = acceleration;
    }
  }

  Parameters parameters_;
  ActingEffects<List> acting_;
  double h_;
  std::array<Mode, kRigModes> modes_{};
  S compliance_{0.0};
};

}  // namespace hotfire::model
