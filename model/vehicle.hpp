// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <utility>

#include "model/actuator/axis.hpp"
#include "model/effects.hpp"
#include "model/engine/bearing_block.hpp"
#include "model/structure/structure.hpp"

namespace hotfire::model {

/// Engines on one structure, each with two hydraulic axes: engines x axes x modes, physics.md section 2. One engine is the
/// TAOS of [GF], four are the MASV of [SD].
///
/// Every axis is an `Axis`, with its own parts and effects. What couples them enters each as motion of its attach point, arm
/// and torque (`Coupling`):
///   stroke    s_i(pitch, yaw) of the attach points in 3-D, and its derivatives as arms (`EngineGeometry`)
///   structure w_i = modes and residual under all forces F and the torques on the gimbals (`ModalStructure`)
///   bearing   translation u under thrust and forces, n_i . u added to w_i; torsion in series with the friction
///             (`CompliantBearing`, with a block between its halves or without)
///   friction  one torque over both angles' slip, beta' - rotation of the vehicle's side - torsion', its level from the
///   force
///             through the bearing (`BearingFriction`)
///   thrust    may change from step to step: level, vibration, seat of the bearing and torque of a misaligned thrust follow
///   ducts     and viscous damping of an axis work against the vehicle's side, as far as it turns.
/// With modes, an axis's `structure.stiffness` is what is local to its attach point, in series with them.
///
/// Discretisation: the axes' own two passes. Over one step all flexibility is a constant symmetric matrix C of mean motion
/// per mean force, so spring forces and motion are found together: F = (1/K_T + C)^-1 (deflection without force, less what
/// the springs' nonlinearity took in the last evaluation). That is exact for linear springs and contracts for softer ones,
/// so a structure softer than the actuators is as stable as a stiff one. Where stiffness follows the thrust, C is that of
/// the step's own. Second order where smooth, first order at stick and
/// slip.
///
/// A step costs the same whatever the state, and is linear in the modes. No allocation, lock or exception after
/// construction.
template <class S, int Engines, int Capacity, class List>
class Vehicle {
 public:
  using Scalar = S;
  using Effects = List;
  using AxisModel = Axis<S, List>;
  static constexpr std::string_view topology = Engines == 1 ? "taos" : "masv";
  static constexpr int kEngines = Engines;
  static constexpr int kAxes = 2 * Engines;  ///< pitch and yaw of engine 1, then of engine 2 ...
  static constexpr int kPorts = 2 * kAxes;   ///< attach points in the order of the axes, then the gimbals' rotations
  static constexpr int kPasses = 2;
  static constexpr std::size_t kChannels = AxisModel::channels.size();
  using Structure = ModalStructure<S, kPorts, Capacity>;
  using Modes = typename Structure::Table;
  using AxisMatrix = Eigen::Matrix<S, kAxes, kAxes>;

  struct Parameters {
    std::array<typename AxisModel::Parameters, kAxes> axes{};
    std::array<AttachPoints<S>, kAxes> attach = representative_attach_points();
    /// True for an engine whose arms are the declared `actuator.moment_arm` at any angle: its attach points are not read.
    std::array<bool, Engines> constant_arms{};
    std::array<GimbalParameters<S>, Engines> gimbals{};
    Modes modes{};
  };

  struct GimbalState {
    typename CompliantBearing<S>::State bearing{};
    Pair<S> bristle{};
    Pair<S> torque{};  ///< of the friction, mean of the last step
  };

  struct State {
    std::array<typename AxisModel::State, kAxes> axes{};
    typename Structure::State structure{};
    std::array<GimbalState, Engines> gimbals{};
    std::array<S, kAxes> softening{};  ///< deflection that a nonlinear spring takes beyond force / K_T [m]
    long long tick = 0;
    std::array<S, kAxes * kChannels> measured{};  ///< piston, engine and load pressure, axis after axis
  };

  /// What drives a step, held over it.
  struct Inputs {
    std::array<S, kAxes> commands{};                     ///< [rad]
    std::array<S, kAxes> vibration{};                    ///< slip velocity of the bearings from a recorded vibration [rad/s]
    std::array<S, Engines> thrust{};                     ///< of an engine, beyond its declared one [N]
    std::array<S, kAxes> torque{};                       ///< on the engine, towards positive angles [N m]
    std::array<Vector3<S>, Engines> force = no_force();  ///< on the engine at its gimbal's centre, along x, y, z [N]
  };

  /// Constants of a run at step `h` [s]. But for constant arms, an axis's moment arm is that of its attach points at zero
  /// angles: the declared one is not read.
  Vehicle(const Parameters& parameters, double h);

  double step_size() const noexcept { return h_; }
  const AxisModel& axis(int i) const noexcept { return axes_[at(i)]; }
  const Structure& structure() const noexcept { return structure_; }
  const EngineGeometry<S>& geometry(int engine) const noexcept { return gimbals_[at(engine)].geometry; }
  bool has_block(int engine) const noexcept { return gimbals_[at(engine)].spring.has_block(); }

  /// The steady state under constant commands [rad]: set-up only. Every axis settles under the motion and torque that the
  /// others' forces give it, until these no longer change; friction starts unloaded. `thrust` is beyond the declared one
  /// [N].
  State steady(const std::array<S, kAxes>& commands, const std::array<S, Engines>& thrust = {}) const;

  /// Advances by one step.
  void step(State& state, const Inputs& inputs) const noexcept;

  static const std::array<S, kAxes * kChannels>& measured(const State& state) noexcept { return state.measured; }

  /// Strokes and arms of one engine's actuators.
  static EngineGeometry<S> geometry_of(const Parameters& parameters, std::size_t engine) {
    const std::size_t pitch = 2 * engine;
    return parameters.constant_arms[engine] ? EngineGeometry<S>(parameters.axes[pitch].actuator.moment_arm,
                                                                parameters.axes[pitch + 1].actuator.moment_arm)
                                            : EngineGeometry<S>(parameters.attach[pitch], parameters.attach[pitch + 1]);
  }

 private:
  struct Gimbal {
    EngineGeometry<S> geometry;
    CompliantBearing<S> spring;
    BearingFriction<S> friction;
    BearingVibration<S> vibration;
    GimbalBearing<S> bearing;
    Pose<S> upright;  ///< at zero angles
    bool vibrates;
  };

  /// How the attach points give way: their mean motion per mean force over a step, and the factor of it in series with the
  /// springs.
  struct Give {
    AxisMatrix flexibility;
    AxisMatrix factor;
  };

  /// One step under way.
  struct Step {
    std::array<typename AxisModel::Advance, kAxes> axes;
    typename Structure::Advance structure;
    std::array<Coupling<S>, kAxes> around{};
    std::array<Spring<S>, kAxes> springs{};
    std::array<typename CompliantBearing<S>::Advance, Engines> bearings;
    std::array<Pose<S>, Engines> poses;
    std::array<Pair<S>, Engines> vibration{};
    std::array<S, Engines> vibrating{};  ///< size of the vibration over the declared one
    std::array<S, Engines> thrust{};
    std::array<S, kAxes> torque{};
    std::array<Vector3<S>, Engines> force;
    Give give;  ///< under this step's thrust; read only where stiffness follows it
  };

  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  static std::array<Vector3<S>, Engines> no_force() noexcept {
    std::array<Vector3<S>, Engines> forces;
    forces.fill(Vector3<S>::Zero());
    return forces;
  }

  static constexpr std::array<AttachPoints<S>, kAxes> representative_attach_points() noexcept {
    std::array<AttachPoints<S>, kAxes> points{};
    for (int e = 0; e < Engines; ++e) {
      points[at(2 * e + 1)] = yaw_attach_points<S>();
    }
    return points;
  }

  template <std::size_t... I>
  static std::array<AxisModel, kAxes> axes_of(const Parameters& parameters, double h, std::index_sequence<I...>) {
    const auto axis = [&](std::size_t i) {
      auto own = parameters.axes[i];
      own.actuator.moment_arm = geometry_of(parameters, i / 2).at(S(0.0), S(0.0)).arm[i % 2][i % 2];
      return AxisModel(own, h);
    };
    return {axis(I)...};
  }

  template <std::size_t... I>
  static std::array<Gimbal, Engines> gimbals_of(const Parameters& parameters, double h, std::index_sequence<I...>) {
    const auto gimbal = [&](std::size_t e) {
      const GimbalParameters<S>& own = parameters.gimbals[e];
      return Gimbal{geometry_of(parameters, e),
                    CompliantBearing<S>(own, h),
                    own.friction,
                    own.vibration,
                    own.bearing,
                    geometry_of(parameters, e).at(S(0.0), S(0.0)),
                    value_of(own.vibration.pitch_velocity) > 0.0 || value_of(own.vibration.yaw_velocity) > 0.0};
    };
    return {gimbal(I)...};
  }

  /// Force on the bearing of an engine: its thrust and dead load, the push of its actuators and a disturbance.
  Vector3<S> bearing_force(const State& state, const Step& step, int e) const noexcept {
    return pushed(state, step.poses[at(e)], step.thrust[at(e)], e) + step.force[at(e)];
  }
  Vector3<S> pushed(const State& state, const Pose<S>& pose, const S& thrust, int e) const noexcept {
    return pose.thrust * (thrust + gimbals_[at(e)].bearing.dead_load) + pose.direction[0] * state.structure.forces(2 * e) +
           pose.direction[1] * state.structure.forces(2 * e + 1);
  }

  /// Fills the inputs of every axis for the step that the inputs found so far lead to.
  void evaluate(State& state, Step& step, Keep keep) const noexcept {
    const auto moved = structure_.attach_motion(state.structure, step.structure);
    Eigen::Matrix<S, kAxes, 1> motion;   // of attach points, and stroke beyond R beta
    Eigen::Matrix<S, kAxes, 1> surplus;  // of deflection over what the forces found so far need
    for (int e = 0; e < Engines; ++e) {
      move_engine(state, step, moved, e, motion, surplus);
    }
    const Give& give = stiffens_ ? step.give : give_;
    motion += times(give.flexibility, solve_factorised<S, kAxes>(give.factor, surplus));
    for (int i = 0; i < kAxes; ++i) {
      auto& axis = state.axes[at(i)];
      step.around[at(i)].motion = motion(i);
      step.springs[at(i)] = axes_[at(i)].evaluate_actuator(axis, step.axes[at(i)], step.around[at(i)], keep);
      state.softening[at(i)] = deflection(step, i, motion(i)) - axis.spring_force / axes_[at(i)].stiffness();
      state.structure.forces(i) = axis.spring_force;
    }
    turn_engines(state, step, keep);
  }

  /// How the attach points give way under a thrust, bearings at zero angles. What the springs take up of their surplus moves
  /// them by flexibility (1 / K_T + flexibility)^-1 of it.
  Give give_under(const std::array<S, Engines>& thrust) const noexcept;

  /// What an attach point gives way by beyond its declared stiffness under a thrust [m/N].
  S further_flexibility(int i, const S& thrust) const noexcept {
    return gimbals_[at(i / 2)].bearing.further_structure(thrust) / axes_[at(i)].parameters().structure.stiffness;
  }

  /// Mean deflection of a load spring before its effects.
  S deflection(const Step& step, int i, const S& motion) const noexcept {
    return step.axes[at(i)].mean(AxisModel::kPiston) -
           axes_[at(i)].parameters().actuator.moment_arm * step.axes[at(i)].mean(AxisModel::kAngle) - motion;
  }

  /// Where one engine goes, and what that leaves of the deflection of its two springs.
  [[gnu::always_inline]] void move_engine(State& state, Step& step, const typename Structure::HalfVector& moved, int e,
                                          Eigen::Matrix<S, kAxes, 1>& motion,
                                          Eigen::Matrix<S, kAxes, 1>& surplus) const noexcept {
    for (int i = 2 * e; i < 2 * e + 2; ++i) {
      axes_[at(i)].predict(state.axes[at(i)], step.axes[at(i)]);
    }
    const S pitch = step.axes[at(2 * e)].mean(AxisModel::kAngle);
    const S yaw = step.axes[at(2 * e + 1)].mean(AxisModel::kAngle);
    const Gimbal& gimbal = gimbals_[at(e)];
    Pose<S>& pose = step.poses[at(e)];
    pose = gimbal.geometry.at(pitch, yaw);
    const GimbalState& own = state.gimbals[at(e)];
    const Vector3<S> moved_bearing =
        gimbal.spring.mean_translation(own.bearing, step.bearings[at(e)], bearing_force(state, step, e), own.torque);
    for (int k = 0; k < 2; ++k) {
      const int i = 2 * e + k;
      const auto& axis = axes_[at(i)];
      motion(i) = pose.stroke[at(k)] - axis.parameters().actuator.moment_arm * (k == 0 ? pitch : yaw) + moved(i) +
                  dot<S>(pose.direction[at(k)], moved_bearing) +
                  further_flexibility(i, step.thrust[at(e)]) * state.structure.forces(i);
      surplus(i) = deflection(step, i, motion(i)) - state.softening[at(i)] - state.structure.forces(i) / axis.stiffness();
      step.around[at(i)].arm = pose.arm[at(k)][at(k)];
    }
  }

  /// Friction of the bearings, torque of each actuator about the other angle, and what the vehicle's own rotation adds.
  void turn_engines(State& state, Step& step, Keep keep) const noexcept {
    const auto turned = structure_.rotation(state.structure, step.structure);
    const auto rate = structure_.rotation_rate(state.structure, step.structure);
    for (int e = 0; e < Engines; ++e) {
      const int pitch = 2 * e;
      const int yaw = pitch + 1;
      // The first pass goes by the last step's friction: the second solves for speed and torque together, from a velocity
      // without friction that does not depend on it.
      if (keep == Keep::yes) {
        slide(state, step, rate, e);
      }
      const Pair<S>& friction = state.gimbals[at(e)].torque;
      const Pose<S>& pose = step.poses[at(e)];
      const GimbalBearing<S>& bearing = gimbals_[at(e)].bearing;
      const S across_pitch = bearing.pitch_misalignment * step.thrust[at(e)] - step.torque[at(pitch)] -
                             pose.arm[1][0] * state.axes[at(yaw)].spring_force;
      const S across_yaw = bearing.yaw_misalignment * step.thrust[at(e)] - step.torque[at(yaw)] -
                           pose.arm[0][1] * state.axes[at(pitch)].spring_force;
      turn_axis(state, step, turned, rate, pitch, friction.pitch, across_pitch, keep);
      turn_axis(state, step, turned, rate, yaw, friction.yaw, across_yaw, keep);
    }
  }

  void turn_axis(State& state, Step& step, const typename Structure::HalfVector& turned,
                 const typename Structure::HalfVector& rate, int i, const S& friction, const S& across,
                 Keep keep) const noexcept {
    const Engine<S>& engine = axes_[at(i)].parameters().engine;
    const S of_vehicle = engine.duct_stiffness * turned(i) + engine.viscous_damping * rate(i);
    const S of_engine = engine.duct_stiffness * step.axes[at(i)].mean(AxisModel::kAngle) +
                        engine.viscous_damping * step.axes[at(i)].rate(AxisModel::kAngle, h_);
    state.structure.forces(kAxes + i) = friction + of_engine - of_vehicle;
    step.around[at(i)].torque = friction + across - of_vehicle;
    const auto& other = step.axes[at(i ^ 1)];
    step.around[at(i)].other_angle = other.mean(AxisModel::kAngle);
    step.around[at(i)].other_rate = other.rate(AxisModel::kAngle, h_);
    axes_[at(i)].evaluate_engine(state.axes[at(i)], step.axes[at(i)], step.springs[at(i)], step.around[at(i)], keep);
  }

  /// Friction of one bearing under the slip that the axes' predictions lead to: advances torque and bristle.
  void slide(State& state, const Step& step, const typename Structure::HalfVector& rate, int e) const noexcept {
    const int pitch = 2 * e;
    const int yaw = pitch + 1;
    const Gimbal& gimbal = gimbals_[at(e)];
    GimbalState& own = state.gimbals[at(e)];
    const Pair<S> engine{step.axes[at(pitch)].rate(AxisModel::kAngle, h_), step.axes[at(yaw)].rate(AxisModel::kAngle, h_)};
    const Pair<S> vehicle{rate(pitch), rate(yaw)};
    const Vector3<S> force = bearing_force(state, step, e);
    const Pair<S> torsion = gimbal.spring.rotation_rate(own.bearing, step.bearings[at(e)], force, own.torque);
    const auto& flexibility = structure_.rate_flexibility();
    const SymmetricPair<S> bearing = gimbal.spring.rate_flexibility();
    Slip<S> slip;
    slip.h = h_;
    slip.velocity = engine - vehicle - torsion + step.vibration[at(e)];
    slip.compliance = {axes_[at(pitch)].engine_compliance() + flexibility(pitch, kAxes + pitch) + bearing.pitch,
                       axes_[at(yaw)].engine_compliance() + flexibility(yaw, kAxes + yaw) + bearing.yaw,
                       flexibility(pitch, kAxes + yaw) + bearing.cross};
    slip.free_velocity = slip.velocity + slip.compliance.times(own.torque);
    own.torque = gimbal.friction.torque(own.bristle, slip, {norm<S>(force), step.vibrating[at(e)]});
  }

  /// What the axes' states at rest do to the rest of the vehicle, and what that does to them.
  void couple_at_rest(State& state, std::array<Coupling<S>, kAxes>& around, const std::array<S, Engines>& thrust) const;

  void gather(State& state) const noexcept {
    for (std::size_t i = 0; i < kAxes; ++i) {
      for (std::size_t channel = 0; channel < kChannels; ++channel) {
        state.measured[i * kChannels + channel] = state.axes[i].measured[channel];
      }
    }
  }

  double h_;
  std::array<AxisModel, kAxes> axes_;
  Structure structure_;
  std::array<Gimbal, Engines> gimbals_;
  Give give_;              ///< under the declared thrust
  bool stiffens_ = false;  ///< structure or bearings are stiffer under thrust
};

template <class S, int Engines, int Capacity, class List>
void Vehicle<S, Engines, Capacity, List>::step(State& state, const Inputs& inputs) const noexcept {
  Step step;
  for (int i = 0; i < kAxes; ++i) {
    axes_[at(i)].begin(state.axes[at(i)], inputs.commands[at(i)], step.axes[at(i)]);
  }
  structure_.begin(state.structure, step.structure);
  for (int e = 0; e < Engines; ++e) {
    const Gimbal& gimbal = gimbals_[at(e)];
    step.thrust[at(e)] = gimbal.bearing.thrust + inputs.thrust[at(e)];
    gimbal.spring.begin(state.gimbals[at(e)].bearing, step.bearings[at(e)]);
    step.vibrating[at(e)] = gimbal.bearing.vibration_under(step.thrust[at(e)]);
    step.vibration[at(e)] = {inputs.vibration[at(2 * e)], inputs.vibration[at(2 * e + 1)]};
    if (gimbal.vibrates) {
      step.vibration[at(e)] =
          step.vibration[at(e)] + step.vibrating[at(e)] * vibration_over(gimbal.vibration, state.tick, h_);
    }
  }
  step.force = inputs.force;
  step.torque = inputs.torque;
  if (stiffens_) {
    step.give = give_under(step.thrust);
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    evaluate(state, step, pass + 1 == kPasses ? Keep::yes : Keep::no);
  }
  for (int i = 0; i < kAxes; ++i) {
    axes_[at(i)].finish(state.axes[at(i)], step.axes[at(i)]);
  }
  structure_.finish(state.structure, step.structure);
  for (int e = 0; e < Engines; ++e) {
    GimbalState& own = state.gimbals[at(e)];
    gimbals_[at(e)].spring.finish(own.bearing, step.bearings[at(e)], bearing_force(state, step, e), own.torque);
  }
  ++state.tick;
  gather(state);
}

/// The presets, with the modes that their memory holds.
template <class S>
using Taos = Vehicle<S, 1, 32, SimplexEffects>;
template <class S>
using Masv = Vehicle<S, 4, 64, MasvEffects>;

#ifdef HOTFIRE_COMPILED_PLANTS
extern template class Vehicle<double, 1, 32, SimplexEffects>;
extern template class Vehicle<double, 4, 64, MasvEffects>;
#endif

}  // namespace hotfire::model

#include "model/vehicle_balance.hpp"
