// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
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

/// The parts of a wave, real and imaginary of one harmonic after another, at the ends of a cycle's samples (even rows) and
/// at their middles (odd rows): what each adds to the signal there, Re(harmonic e^{i pi m row / samples}).
inline const Eigen::MatrixXd& sines() {
  static const Eigen::MatrixXd all = [] {
    Eigen::MatrixXd own(2 * kSamples + 1, 2 * kMostHarmonics);
    for (Eigen::Index row = 0; row < own.rows(); ++row) {
      for (Eigen::Index m = 1; m <= kMostHarmonics; ++m) {
        const auto turns = static_cast<double>(m * row % (2 * kSamples)) / kSamples;
        own(row, 2 * m - 2) = std::cos(std::numbers::pi * turns);
        own(row, 2 * m - 1) = -std::sin(std::numbers::pi * turns);
      }
    }
    return own;
  }();
  return all;
}

/// A wave at the ends of the samples of a cycle, and at their middles.
class Sampled {
 public:
  Sampled(const Wave& wave, int harmonics) {
    Eigen::VectorXd parts(2 * harmonics);
    for (Eigen::Index m = 0; m < harmonics; ++m) {
      const Complex& harmonic = wave.harmonics[static_cast<std::size_t>(m)];
      parts.segment<2>(2 * m) << harmonic.real(), harmonic.imag();
    }
    values_ = (sines().leftCols(parts.size()) * parts).array() + wave.mean;
  }

  double start(int sample) const { return values_(2 * sample); }
  double middle(int sample) const { return values_(2 * sample + 1); }
  double end(int sample) const { return values_(2 * sample + 2); }

 private:
  Eigen::VectorXd values_;
};

/// Signals at the middles of a cycle's samples, a column each.
template <int signals>
using Middles = Eigen::Matrix<double, kSamples, signals>;

/// Mean and first `harmonics` harmonics of signals.
template <int signals>
std::array<Wave, signals> waves_of(const Middles<signals>& values, int harmonics) {
  static const Eigen::MatrixXd weights = [] {
    Eigen::MatrixXd own(2 * kMostHarmonics, kSamples);
    for (Eigen::Index k = 0; k < kSamples; ++k) {
      own.col(k) = (2.0 / kSamples) * sines().row(2 * k + 1).transpose();
    }
    return own;
  }();
  const Eigen::Matrix<double, Eigen::Dynamic, signals> parts = weights.topRows(2 * harmonics) * values;
  std::array<Wave, signals> waves;
  for (int i = 0; i < signals; ++i) {
    Wave& wave = waves[static_cast<std::size_t>(i)];
    wave.mean = values.col(i).mean();
    for (Eigen::Index m = 0; m < harmonics; ++m) {
      wave.harmonics[static_cast<std::size_t>(m)] = Complex(parts(2 * m, i), parts(2 * m + 1, i));
    }
  }
  return waves;
}

/// Runs `cycle(values)`, which fills the samples of `signals` signals, until they repeat themselves: their first `harmonics`
/// harmonics.
template <int signals, class Cycle>
std::array<Wave, signals> repeated(int harmonics, Cycle&& cycle) {
  Middles<signals> last;
  Middles<signals> next;
  cycle(last);
  for (int round = 1; round < kMostCycles; ++round) {
    cycle(next);
    const auto change = (next - last).cwiseAbs().colwise().maxCoeff().eval();
    const auto size = next.cwiseAbs().colwise().maxCoeff().eval();
    last = next;
    if ((change.array() <= kSameCycle * size.array()).all()) {
      break;
    }
  }
  return waves_of<signals>(last, harmonics);
}

/// The laws of one axis under an imposed motion: the model's own evaluation of a step (`Axis::evaluate`), of which the
/// motion is given at both ends instead of found. The axis is one of piston and engine so heavy that no force of a step
/// moves them.
template <class AxisModel>
class AxisLaws {
 public:
  using State = typename AxisModel::State;
  static constexpr int kSignals = kSitePorts + 1;  ///< the ports, and the command behind its effects [rad]

  /// `rest` is the axis at rest under `command` [rad].
  AxisLaws(const typename AxisModel::Parameters& parameters, double frequency, int harmonics, const State& rest,
           double command)
      : harmonics_(harmonics),
        h_(1.0 / (frequency * kSamples)),
        axis_(heavy(parameters), h_),
        rest_(rest),
        command_(command) {
    // Where the attach point is at rest: the motion under which the spring has its force. A spring is never stiffer than
    // K_T.
    constexpr int kRounds = 60;
    const Imposed still{AxisWaves{}, Wave{}, harmonics_};
    for (int round = 0; round < kRounds; ++round) {
      State state = rest_;
      at_rest_ = one(state, still, 0);
      attach_ += (state.spring_force - rest_.spring_force) / axis_.stiffness();
    }
  }

  /// `other` is the engine's motion about its other axis, `moved` are deviations from rest.
  std::array<Wave, kSignals> respond(const AxisWaves& moved, const Wave& other) const {
    const Imposed imposed{moved, other, harmonics_};
    State state = rest_;
    return repeated<kSignals>(harmonics_, [&](auto& values) {
      for (int k = 0; k < kSamples; ++k) {
        const auto found = one(state, imposed, k);
        for (std::size_t i = 0; i < found.size(); ++i) {
          values(k, static_cast<Eigen::Index>(i)) = found[i] - at_rest_[i];
        }
      }
    });
  }

 private:
  struct Imposed {
    Imposed(const AxisWaves& moved, const Wave& other_angle, int harmonics)
        : command(moved.command, harmonics), attach(moved.attach, harmonics), other(other_angle, harmonics) {
      for (const Wave& state : moved.states) {
        states.emplace_back(state, harmonics);
      }
    }
    std::vector<Sampled> states{};
    Sampled command;
    Sampled attach;
    Sampled other;
  };

  /// The signals of one sample.
  std::array<double, kSignals> one(State& state, const Imposed& imposed, int k) const {
    typename AxisModel::Advance advance;
    for (int i = 0; i < 8; ++i) {
      state.y(i) = rest_.y(i) + imposed.states[static_cast<std::size_t>(i)].start(k);
    }
    axis_.begin(state, command_ + imposed.command.middle(k), advance);
    for (int i = 0; i < 8; ++i) {
      advance.end(i) = rest_.y(i) + imposed.states[static_cast<std::size_t>(i)].end(k);
    }
    advance.middle = 0.5 * (advance.start + advance.end);
    advance.built_up = state.built_up;
    const double arm = axis_.parameters().actuator.moment_arm;
    model::Coupling<double> around{attach_ + imposed.attach.middle(k), arm, 0.0};
    around.other_angle = imposed.other.middle(k);
    around.other_rate = (imposed.other.end(k) - imposed.other.start(k)) / h_;
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

  int harmonics_;
  double h_;
  AxisModel axis_;
  State rest_;
  double command_;
  double attach_ = 0.0;  ///< motion of the attach point at rest [m]
  std::array<double, kSignals> at_rest_{};
};

/// The friction torque of a bearing, about pitch and yaw, under an imposed slip [rad] (`BearingFriction`).
inline std::array<Wave, 2> friction_of(const model::BearingFriction<double>& law,
                                       const model::BearingCondition<double>& condition, double frequency, int harmonics,
                                       const Wave& pitch_slip, const Wave& yaw_slip) {
  const double h = 1.0 / (frequency * kSamples);
  const Sampled pitch(pitch_slip, harmonics);
  const Sampled yaw(yaw_slip, harmonics);
  const auto velocity = [&](int sample) {
    const int k = (sample + kSamples) % kSamples;
    return model::Pair<double>{(pitch.end(k) - pitch.start(k)) / h, (yaw.end(k) - yaw.start(k)) / h};
  };
  const bool is_rigid = law.law() == model::BearingFriction<double>::Law::coulomb;
  const double least_compliance = 1e-300;
  model::Pair<double> bristle{};
  return repeated<2>(harmonics, [&](auto& values) {
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
      values(k, 0) = torque.pitch;
      values(k, 1) = torque.yaw;
    }
  });
}

}  // namespace hotfire::linear
