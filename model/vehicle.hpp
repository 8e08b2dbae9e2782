// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "model/effects.hpp"
#include "model/structure/structure.hpp"
#include "model/vehicle_engine.hpp"
#include "model/vehicle_lanes.hpp"

namespace hotfire::model {

/// How the engines of a vehicle step. `side_by_side` in lanes falls back to `one_by_one` if the engines differ in more than
/// numbers. Both give the same bits.
enum class Stepping { side_by_side, one_by_one };

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
///             force through the bearing (`BearingFriction`)
///   thrust    may change from step to step: level, vibration, seat of the bearing and torque of a misaligned thrust follow
///   ducts     and viscous damping of an axis work against the vehicle's side, as far as it turns.
/// With modes, an axis's `structure.stiffness` is what is local to its attach point, in series with them.
///
/// Discretisation: the axes' own two passes. Over one step all flexibility is a constant symmetric matrix C of mean motion
/// per mean force, so spring forces and motion are found together: F = (1/K_T + C)^-1 (deflection without force, less what
/// the springs' nonlinearity took in the last evaluation). That is exact for linear springs and contracts for softer ones,
/// so a structure softer than the actuators is as stable as a stiff one. Where stiffness follows the thrust, C is that of
/// the step's own. Second order where smooth, first order at stick and slip.
///
/// A step costs the same whatever the state, and is linear in the modes. No allocation, lock or exception after
/// construction. Four engines with the same effects and laws step side by side in lanes, which costs about half as much.
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

  struct State {
    std::array<typename AxisModel::State, kAxes> axes{};  ///< their clocks all count the same steps
    typename Structure::State structure{};
    std::array<GimbalState<S>, Engines> gimbals{};
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
  Vehicle(const Parameters& parameters, double h, Stepping stepping = Stepping::side_by_side);

  double step_size() const noexcept { return h_; }
  bool steps_side_by_side() const noexcept { return !std::holds_alternative<Alone>(engines_); }
  const Structure& structure() const noexcept { return structure_; }
  bool has_block(int engine) const noexcept { return has_block_[at(engine)]; }

  /// One axis as it is alone, and strokes and arms of one engine's actuators. Copies: set-up only.
  AxisModel axis(int i) const;
  EngineGeometry<S> geometry(int engine) const;

  /// The steady state under constant commands [rad]: set-up only. Every axis settles under the motion and torque that the
  /// others' forces give it, until these no longer change; friction starts unloaded. `thrust` is beyond the declared one
  /// [N].
  State steady(const std::array<S, kAxes>& commands, const std::array<S, Engines>& thrust = {}) const;

  /// Advances by one step.
  void step(State& state, const Inputs& inputs) const noexcept;

  static const std::array<S, kAxes * kChannels>& measured(const State& state) noexcept { return state.measured; }

  /// Strokes and arms of one engine's actuators.
  static EngineGeometry<S> geometry_of(const Parameters& parameters, std::size_t engine) {
    return parameters_of(parameters, engine).geometry();
  }

 private:
  using EngineModel = VehicleEngine<S, List>;
  using EngineParameters = std::array<typename EngineModel::Parameters, Engines>;
  using Alone = std::array<EngineModel, Engines>;
  static constexpr bool kMayRunSideBySide = may_run_side_by_side<S, Engines, List>();
  /// Lanes come by fours. With another number of engines the type is not used.
  using SideBySide = EnginesSideBySide<(Engines + 3) / 4 * 4, List>;
  using Form = std::conditional_t<kMayRunSideBySide, std::variant<Alone, SideBySide>, std::variant<Alone>>;

  // The step is one template: T is S, with one engine after the other, or `Lanes`, with all engines at once.
  template <class T>
  static constexpr std::size_t kSteps = are_lanes<T> ? 1 : Engines;
  template <class T>
  using EnginesIn = std::array<VehicleEngine<T, List>, kSteps<T>>;
  template <class T>
  using Both = std::array<T, 2>;

  /// How the attach points give way: their mean motion per mean force over a step, and the factor of it in series with the
  /// springs.
  struct Give {
    AxisMatrix flexibility;
    AxisMatrix factor;
  };

  /// One step under way.
  template <class T>
  struct Step {
    std::array<typename VehicleEngine<T, List>::Step, kSteps<T>> engines;
    typename Structure::Advance structure;
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

  static typename EngineModel::Parameters parameters_of(const Parameters& parameters, std::size_t engine) {
    const std::size_t pitch = 2 * engine;
    return {{parameters.axes[pitch], parameters.axes[pitch + 1]},
            {parameters.attach[pitch], parameters.attach[pitch + 1]},
            parameters.constant_arms[engine],
            parameters.gimbals[engine]};
  }

  /// What `of(e)` is for engine e, or for all of them in lanes.
  template <class T, class F>
  [[gnu::always_inline]] static T over_engines(std::size_t e, const F& of) noexcept {
    if constexpr (are_lanes<T>) {
      return T::by_lane([&](int lane) __attribute__((always_inline)) { return of(at(lane)); });
    } else {
      return of(e);
    }
  }

  /// The entries of an engine's pitch and yaw axes. `first` is the entry of the pitch axis of engine 1.
  template <class T, class Values>
  [[gnu::always_inline]] static Both<T> both_of(const Values& values, std::size_t e, std::size_t first = 0) noexcept {
    return {over_engines<T>(e, [&](std::size_t own) { return values[first + 2 * own]; }),
            over_engines<T>(e, [&](std::size_t own) { return values[first + 2 * own + 1]; })};
  }

  /// Writes both entries: the inverse of `both_of`.
  template <class T, class Values>
  [[gnu::always_inline]] static void put(const Both<T>& both, std::size_t e, Values& values,
                                         std::size_t first = 0) noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      if constexpr (are_lanes<T>) {
        for (int lane = 0; lane < T::kLanes; ++lane) {
          values[first + 2 * at(lane) + k] = both[k][lane];
        }
      } else {
        values[first + 2 * e + k] = both[k];
      }
    }
  }

  template <class T>
  static typename VehicleEngine<T, List>::Inputs inputs_of(const Inputs& inputs, std::size_t e) noexcept {
    typename VehicleEngine<T, List>::Inputs own{both_of<T>(inputs.commands, e),
                                                both_of<T>(inputs.vibration, e),
                                                over_engines<T>(e, [&](std::size_t i) { return inputs.thrust[i]; }),
                                                both_of<T>(inputs.torque, e),
                                                {}};
    for (int k = 0; k < 3; ++k) {
      own.force(k) = over_engines<T>(e, [&](std::size_t i) { return inputs.force[i](k); });
    }
    return own;
  }

  template <std::size_t... I>
  static EngineParameters engine_parameters(const Parameters& parameters, std::index_sequence<I...>) {
    return {parameters_of(parameters, I)...};
  }
  static EngineParameters engine_parameters(const Parameters& parameters) {
    return engine_parameters(parameters, std::make_index_sequence<Engines>{});
  }

  static Form form_of(const Parameters& parameters, double h, Stepping stepping);

  /// Calls `f<T>` with the engines as they step.
  template <class F>
  void with_engines(const F& f);

  /// Calls `f` with engines that are not in lanes: set-up only.
  template <class F>
  auto with_engines_alone(const F& f) const;

  /// The engines at rest, all in `state`, and what that does to the rest of the vehicle and back to the axes.
  void couple_at_rest(const Alone& engines, State& state, std::array<Coupling<S>, kAxes>& around,
                      const std::array<S, Engines>& thrust) const;

  /// How the attach points give way under a thrust, bearings at zero angles. What the springs take up of their surplus moves
  /// them by flexibility (1 / K_T + flexibility)^-1 of it.
  template <class T>
  Give give_under(const EnginesIn<T>& engines, const std::array<T, kSteps<T>>& thrust) const noexcept;

  static typename EngineModel::State state_of(State& state, std::size_t e) noexcept {
    return {std::span<typename AxisModel::State, 2>(&state.axes[2 * e], 2), state.gimbals[e]};
  }

  /// Fills the inputs of every axis for the step that the inputs found so far lead to. `engine(e)` is the state of engine e.
  template <class T, class EngineState>
  void evaluate(const EnginesIn<T>& engines, const EngineState& engine, State& state, Step<T>& step,
                Keep keep) const noexcept {
    const auto moved = structure_.attach_motion(state.structure, step.structure);
    Eigen::Matrix<S, kAxes, 1> motion;   // of attach points, and stroke beyond R beta
    Eigen::Matrix<S, kAxes, 1> surplus;  // of deflection over what the forces found so far need
    for (std::size_t e = 0; e < engines.size(); ++e) {
      Both<T> own_motion;
      Both<T> own_surplus;
      engines[e].move(engine(e), both_of<T>(moved, e), step.engines[e], own_motion, own_surplus);
      put<T>(own_motion, e, motion);
      put<T>(own_surplus, e, surplus);
    }
    const Give& give = stiffens_ ? step.give : give_;
    motion += times(give.flexibility, solve_factorised<S, kAxes>(give.factor, surplus));
    for (std::size_t e = 0; e < engines.size(); ++e) {
      engines[e].push(engine(e), both_of<T>(motion, e), step.engines[e], keep);
      put<T>(step.engines[e].push, e, state.structure.forces);
    }
    const auto turned = structure_.rotation(state.structure, step.structure);
    const auto rate = structure_.rotation_rate(state.structure, step.structure);
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const Both<T> torques = engines[e].turn(engine(e), both_of<T>(turned, e), both_of<T>(rate, e), step.engines[e], keep);
      put<T>(torques, e, state.structure.forces, kAxes);
    }
  }

  template <class T, class EngineState>
  [[gnu::always_inline]] void step_engines(const EnginesIn<T>& engines, const EngineState& engine, State& state,
                                           const Inputs& inputs) const noexcept {
    Step<T> step;
    for (std::size_t e = 0; e < engines.size(); ++e) {
      engines[e].begin(engine(e), inputs_of<T>(inputs, e), both_of<T>(state.structure.forces, e),
                       both_of<T>(state.softening, e), state.tick, step.engines[e]);
    }
    structure_.begin(state.structure, step.structure);
    if (stiffens_) {
      std::array<T, kSteps<T>> thrust;
      for (std::size_t e = 0; e < engines.size(); ++e) {
        thrust[e] = step.engines[e].thrust;
      }
      step.give = give_under<T>(engines, thrust);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
      evaluate<T>(engines, engine, state, step, pass + 1 == kPasses ? Keep::yes : Keep::no);
    }
    structure_.finish(state.structure, step.structure);
    for (std::size_t e = 0; e < engines.size(); ++e) {
      engines[e].finish(engine(e), step.engines[e]);
      put<T>(step.engines[e].softening, e, state.softening);
    }
  }

  void gather(State& state) const noexcept {
    for (std::size_t i = 0; i < kAxes; ++i) {
      for (std::size_t channel = 0; channel < kChannels; ++channel) {
        state.measured[i * kChannels + channel] = state.axes[i].measured[channel];
      }
    }
  }

  double h_;
  Structure structure_;
  std::array<bool, Engines> has_block_{};
  Form engines_;
  Give give_;              ///< under the declared thrust
  bool stiffens_ = false;  ///< structure or bearings are stiffer under thrust
};

template <class S, int Engines, int Capacity, class List>
void Vehicle<S, Engines, Capacity, List>::step(State& state, const Inputs& inputs) const noexcept {
  if (const Alone* alone = std::get_if<Alone>(&engines_)) {
    step_engines<S>(
        *alone, [&](std::size_t e) { return state_of(state, e); }, state, inputs);
  }
  if constexpr (kMayRunSideBySide) {
    if (const SideBySide* beside = std::get_if<SideBySide>(&engines_)) {
      typename SideBySide::State own;
      beside->take_in(state, own);
      using All = typename SideBySide::Engine::State;
      step_engines<typename SideBySide::Number>(
          beside->engines(),
          [&](std::size_t) {
            return All{own.all.axes, own.all.gimbal};
          },
          state, inputs);
      beside->give_back(own, state);
    }
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
