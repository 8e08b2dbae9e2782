// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/linear/plant/plant.hpp"
#include "tools/linear/plant/scalars.hpp"

namespace hotfire::linear {

/// Samples of a cycle. A harmonic by the midpoint rule over a signal with corners is off by less than (m / samples)^2.
inline constexpr int kSamples = 128;
/// Cycles that what an effect remembers may take to repeat itself, and what is the same: relative to the largest harmonic.
inline constexpr int kMostCycles = 40;
inline constexpr double kSameCycle = 1e-8;

/// e^{i pi k / samples}: the sines of a cycle at the ends of its samples (k even) and at their middles (k odd).
inline const Complex& turn_at(int k) {
  static const auto turns = [] {
    std::array<Complex, 2 * kSamples> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = std::polar(1.0, std::numbers::pi * static_cast<double>(i) / kSamples);
    }
    return all;
  }();
  return turns[static_cast<std::size_t>(k % (2 * kSamples))];
}

/// A wave at the ends of the samples of a cycle, and at their middles.
struct Sampled {
  std::vector<double> ends;     ///< from the start of the first sample on: one more than there are samples
  std::vector<double> middles;  ///< one a sample

  explicit Sampled(const Wave& wave) : ends(kSamples + 1), middles(kSamples) {
    for (int k = 0; k <= 2 * kSamples; ++k) {
      double value = wave.mean;
      for (int m = 1; m <= kHarmonics; ++m) {
        const Complex& harmonic = wave.harmonics[static_cast<std::size_t>(m - 1)];
        const Complex& turn = turn_at(m * k);
        value += harmonic.real() * turn.real() - harmonic.imag() * turn.imag();
      }
      (k % 2 == 0 ? ends : middles)[static_cast<std::size_t>(k / 2)] = value;
    }
  }
};

/// Mean and harmonics of signals that are known at the middle of every sample: `values[i][k]` of signal i at sample k.
template <std::size_t signals>
std::array<Wave, signals> waves_of(const std::array<std::array<double, kSamples>, signals>& values) {
  std::array<Wave, signals> waves;
  for (std::size_t i = 0; i < signals; ++i) {
    for (int k = 0; k < kSamples; ++k) {
      const double share = values[i][static_cast<std::size_t>(k)] / kSamples;
      waves[i].mean += share;
      for (int m = 1; m <= kHarmonics; ++m) {
        waves[i].harmonics[static_cast<std::size_t>(m - 1)] += 2.0 * share * std::conj(turn_at(m * (2 * k + 1)));
      }
    }
  }
  return waves;
}

/// Runs `cycle(values)`, which fills the samples of `signals` signals, until they repeat themselves.
template <std::size_t signals, class Cycle>
std::array<Wave, signals> repeated(Cycle&& cycle) {
  std::array<std::array<double, kSamples>, signals> last{};
  std::array<std::array<double, kSamples>, signals> next{};
  cycle(last);
  for (int round = 1; round < kMostCycles; ++round) {
    cycle(next);
    bool same = true;
    for (std::size_t i = 0; i < signals; ++i) {
      double change = 0.0;
      double size = 0.0;
      for (std::size_t k = 0; k < kSamples; ++k) {
        change = std::max(change, std::abs(next[i][k] - last[i][k]));
        size = std::max(size, std::abs(next[i][k]));
      }
      same = same && !(change > kSameCycle * size);
    }
    std::swap(last, next);
    if (same) {
      break;
    }
  }
  return waves_of(last);
}

/// The laws of one axis under an imposed motion: the model's own evaluation of a step (`Axis::evaluate`), of which the
/// motion is given at both ends instead of found. The axis is one of piston and engine so heavy that no force of a step
/// moves them.
template <class AxisModel>
class AxisLaws {
 public:
  using State = typename AxisModel::State;
  static constexpr std::size_t kSignals = kSitePorts + 1;  ///< the ports, and the command behind its effects [rad]

  /// `rest` is the axis at rest under `command` [rad].
  AxisLaws(const typename AxisModel::Parameters& parameters, double frequency, const State& rest, double command)
      : h_(1.0 / (frequency * kSamples)), axis_(heavy(parameters), h_), rest_(rest), command_(command) {
    // Where the attach point is at rest: the motion under which the spring has its force. A spring is never stiffer than
    // K_T.
    constexpr int kRounds = 60;
    const Imposed still{AxisWaves{}, Wave{}};
    for (int round = 0; round < kRounds; ++round) {
      State state = rest_;
      at_rest_ = one(state, still, 0);
      attach_ += (state.spring_force - rest_.spring_force) / axis_.stiffness();
    }
  }

  /// `other` is the engine's motion about its other axis, `moved` are deviations from rest.
  std::array<Wave, kSignals> respond(const AxisWaves& moved, const Wave& other) const {
    const Imposed imposed{moved, other};
    State state = rest_;
    return repeated<kSignals>([&](auto& values) {
      for (int k = 0; k < kSamples; ++k) {
        const auto found = one(state, imposed, k);
        for (std::size_t i = 0; i < kSignals; ++i) {
          values[i][static_cast<std::size_t>(k)] = found[i] - at_rest_[i];
        }
      }
    });
  }

 private:
  struct Imposed {
    Imposed(const AxisWaves& moved, const Wave& other_angle)
        : states(moved.states.begin(), moved.states.end()),
          command(moved.command),
          attach(moved.attach),
          other(other_angle) {}
    std::vector<Sampled> states;
    Sampled command;
    Sampled attach;
    Sampled other;
  };

  /// The signals of one sample.
  std::array<double, kSignals> one(State& state, const Imposed& imposed, int sample) const {
    const auto k = static_cast<std::size_t>(sample);
    typename AxisModel::Advance advance;
    for (int i = 0; i < 8; ++i) {
      state.y(i) = rest_.y(i) + imposed.states[static_cast<std::size_t>(i)].ends[k];
    }
    axis_.begin(state, command_ + imposed.command.middles[k], advance);
    for (int i = 0; i < 8; ++i) {
      advance.end(i) = rest_.y(i) + imposed.states[static_cast<std::size_t>(i)].ends[k + 1];
    }
    advance.middle = 0.5 * (advance.start + advance.end);
    advance.built_up = state.built_up;
    const double arm = axis_.parameters().actuator.moment_arm;
    model::Coupling<double> around{attach_ + imposed.attach.middles[k], arm, 0.0};
    around.other_angle = imposed.other.middles[k];
    around.other_rate = (imposed.other.ends[k + 1] - imposed.other.ends[k]) / h_;
    axis_.evaluate(state, advance, around, model::Keep::no);
    axis_.evaluate(state, advance, around, model::Keep::yes);
    state.clock.steps += 1.0;
    const double linear = advance.mean(AxisModel::kPiston) - arm * advance.mean(AxisModel::kAngle) - around.motion;
    const auto& inputs = state.inputs;
    return {inputs(AxisModel::kValveCommand), inputs(AxisModel::kFlow),
            inputs(AxisModel::kPistonForce),  state.spring_force / axis_.stiffness() - linear,
            inputs(AxisModel::kEngineTorque), inputs(AxisModel::kCommand) / arm};
  }

  static typename AxisModel::Parameters heavy(typename AxisModel::Parameters parameters) {
    constexpr double kHeavy = 1e12;  // a step's velocity changes by a part in 1e9 of what the friction of any axis gives
    parameters.actuator.piston_mass *= kHeavy;
    parameters.engine.inertia *= kHeavy;
    return parameters;
  }

  double h_;
  AxisModel axis_;
  State rest_;
  double command_;
  double attach_ = 0.0;  ///< motion of the attach point at rest [m]
  std::array<double, kSignals> at_rest_{};
};

/// The friction torque of a bearing, about pitch and yaw, under an imposed slip [rad] (`BearingFriction`).
inline std::array<Wave, 2> friction_of(const model::BearingFriction<double>& law,
                                       const model::BearingCondition<double>& condition, double frequency,
                                       const Wave& pitch_slip, const Wave& yaw_slip) {
  const double h = 1.0 / (frequency * kSamples);
  const Sampled pitch(pitch_slip);
  const Sampled yaw(yaw_slip);
  const auto velocity = [&](int sample) {
    const auto k = static_cast<std::size_t>((sample + kSamples) % kSamples);
    return model::Pair<double>{(pitch.ends[k + 1] - pitch.ends[k]) / h, (yaw.ends[k + 1] - yaw.ends[k]) / h};
  };
  const bool is_rigid = law.law() == model::BearingFriction<double>::Law::coulomb;
  const double least_compliance = 1e-300;
  model::Pair<double> bristle{};
  return repeated<2>([&](auto& values) {
    for (int k = 0; k < kSamples; ++k) {
      model::Slip<double> slip;
      slip.h = h;
      slip.velocity = velocity(k);
      slip.free_velocity = slip.velocity;
      if (is_rigid) {
        // Rigid friction changes its sign within a sample: its mean there, for a velocity that changes linearly.
        const model::Pair<double> before = velocity(k - 1);
        const model::Pair<double> after = velocity(k + 1);
        const double change = 0.5 * std::hypot(after.pitch - before.pitch, after.yaw - before.yaw);
        const double share = 0.5 * change / std::max(law.sliding_torque(condition.load), least_compliance);
        slip.compliance = {share, share, 0.0};
      }
      const model::Pair<double> torque = law.torque(bristle, slip, condition);
      values[0][static_cast<std::size_t>(k)] = torque.pitch;
      values[1][static_cast<std::size_t>(k)] = torque.yaw;
    }
  });
}

}  // namespace hotfire::linear
