// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "model/actuator/axis.hpp"
#include "model/engine/bearing_block.hpp"
#include "model/engine/geometry.hpp"
#include "model/engine/gimbal.hpp"

namespace hotfire::model {

/// What the bearing of an engine remembers.
template <class S>
struct GimbalState {
  typename CompliantBearing<S>::State bearing{};
  Pair<S> bristle{};
  Pair<S> torque{};  ///< of the friction, mean of the last step
};

/// One engine of a `Vehicle` on its bearing, with its two axes: what a step does between the modes of the structure. In
/// `Lanes` it is several engines side by side. Every pair is (pitch, yaw).
template <class S, class List>
class VehicleEngine {
 public:
  using AxisModel = Axis<S, List>;
  using Bearing = CompliantBearing<S>;
  using Both = std::array<S, 2>;

  struct Parameters {
    std::array<typename AxisModel::Parameters, 2> axes;
    std::array<AttachPoints<S>, 2> attach;
    bool constant_arms;
    GimbalParameters<S> gimbal;

    EngineGeometry<S> geometry() const {
      return constant_arms ? EngineGeometry<S>(axes[0].actuator.moment_arm, axes[1].actuator.moment_arm)
                           : EngineGeometry<S>(attach[0], attach[1]);
    }
  };

  /// References to the state of an engine, which the caller owns.
  struct State {
    std::span<typename AxisModel::State, 2> axes;
    GimbalState<S>& gimbal;
  };

  /// What drives a step: `Vehicle::Inputs` of one engine.
  struct Inputs {
    Both commands;
    Both vibration;
    S thrust;
    Both torque;
    Vector3<S> force;
  };

  /// One step under way.
  struct Step {
    std::array<typename AxisModel::Advance, 2> axes;
    std::array<Coupling<S>, 2> around;
    std::array<Spring<S>, 2> springs;
    typename Bearing::Advance bearing;
    Pose<S> pose;
    Pair<S> vibration;
    S vibrating;       ///< size of the vibration over the declared one
    S thrust;          ///< [N]
    Both torque;       ///< on the engine, towards positive angles [N m]
    Vector3<S> force;  ///< on the engine at its gimbal's centre [N]
    Both further;      ///< flexibility of the attach points beyond the declared one [m/N]
    Both push;         ///< force of the load springs, as far as it is found [N]
    Both softening;    ///< deflection that a nonlinear spring takes beyond force / K_T [m]
  };

  /// Mean motion of the attach points per mean force on them that is not of the structure's modes [m/N].
  struct Flexibility {
    Both own;
    S cross;
  };

  /// `modes` are those of the bearing's block.
  VehicleEngine(const Parameters& parameters, const typename Bearing::Block::Table& modes, double h)
      : h_(h),
        axes_{axis_of(parameters, 0, h), axis_of(parameters, 1, h)},
        geometry_(parameters.geometry()),
        spring_(parameters.gimbal, modes, h),
        friction_(parameters.gimbal.friction),
        vibration_(parameters.gimbal.vibration),
        bearing_(parameters.gimbal.bearing),
        upright_(geometry_.at(S(0.0), S(0.0))),
        vibrates_(parameters.gimbal.vibration.vibrates()) {}

  /// But for constant arms, an axis's moment arm is that of its attach points at zero angles.
  static AxisModel axis_of(const Parameters& parameters, std::size_t k, double h) {
    auto own = parameters.axes[k];
    own.actuator.moment_arm = parameters.geometry().at(S(0.0), S(0.0)).arm[k][k];
    return AxisModel(own, h);
  }

  const AxisModel& axis(std::size_t k) const noexcept { return axes_[k]; }
  const EngineGeometry<S>& geometry() const noexcept { return geometry_; }
  const S& declared_thrust() const noexcept { return bearing_.thrust; }
  /// True if structure or bearing are stiffer under thrust.
  bool stiffens() const noexcept {
    return anywhere(value_of(bearing_.unloaded_structure) < 1.0) || anywhere(value_of(bearing_.unloaded_stiffness) < 1.0);
  }

  /// Sets the rate flexibility of the structure at the gimbal: mean rate of its rotations per mean torque on it
  /// [rad/s/(N m)].
  void set_rate_flexibility(const SymmetricPair<S>& rate_flexibility) noexcept {
    const SymmetricPair<S> bearing = spring_.rate_flexibility();
    slip_compliance_ = {axes_[0].engine_compliance() + rate_flexibility.pitch + bearing.pitch,
                        axes_[1].engine_compliance() + rate_flexibility.yaw + bearing.yaw,
                        rate_flexibility.cross + bearing.cross};
  }

  /// How the bearing and what seats under a thrust [N] give way, at zero angles.
  Flexibility flexibility(const S& thrust) const noexcept {
    const Vector3<S> load = upright_.thrust * (thrust + bearing_.dead_load);
    const auto& direction = upright_.direction;
    const S pitch = spring_.mean_flexibility(direction[0], direction[0], load);
    const S yaw = spring_.mean_flexibility(direction[1], direction[1], load);
    return {{pitch + further_flexibility(0, thrust), yaw + further_flexibility(1, thrust)},
            spring_.mean_flexibility(direction[0], direction[1], load)};
  }

  /// Opens step number `tick`. `push` and `softening` are those of the last step.
  void begin(const State& state, const Inputs& inputs, const Both& push, const Both& softening, long long tick,
             Step& step) const noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      axes_[k].begin(state.axes[k], inputs.commands[k], step.axes[k]);
    }
    step.thrust = bearing_.thrust + inputs.thrust;
    spring_.begin(state.gimbal.bearing, step.bearing);
    step.vibrating = bearing_.vibration_under(step.thrust);
    step.vibration = {inputs.vibration[0], inputs.vibration[1]};
    if (vibrates_) {
      step.vibration = step.vibration + step.vibrating * vibration_over(vibration_, tick, h_);
    }
    step.force = inputs.force;
    step.torque = inputs.torque;
    step.further = {further_flexibility(0, step.thrust), further_flexibility(1, step.thrust)};
    step.push = push;
    step.softening = softening;
  }

  /// Where the engine goes under the inputs found so far: `motion` of its attach points, to which the structure contributes
  /// `moved`, and stroke beyond R beta [m]. `surplus` is the deflection of its springs over what their forces need [m].
  [[gnu::always_inline]] void move(const State& state, const Both& moved, Step& step, Both& motion,
                                   Both& surplus) const noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      axes_[k].predict(state.axes[k], step.axes[k]);
    }
    const S pitch = step.axes[0].mean(AxisModel::kAngle);
    const S yaw = step.axes[1].mean(AxisModel::kAngle);
    Pose<S>& pose = step.pose;
    pose = geometry_.at(pitch, yaw);
    const GimbalState<S>& own = state.gimbal;
    const Vector3<S> moved_bearing = spring_.mean_translation(own.bearing, step.bearing, bearing_force(step), own.torque);
    for (std::size_t k = 0; k < 2; ++k) {
      motion[k] = pose.stroke[k] - axes_[k].parameters().actuator.moment_arm * (k == 0 ? pitch : yaw) + moved[k] +
                  dot<S>(pose.direction[k], moved_bearing) + step.further[k] * step.push[k];
      surplus[k] = deflection(step, k, motion[k]) - step.softening[k] - step.push[k] / axes_[k].stiffness();
      step.around[k].arm = pose.arm[k][k];
    }
  }

  /// Valves, pistons and load springs under a motion of the attach points.
  void push(const State& state, const Both& motion, Step& step, Keep keep) const noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      auto& axis = state.axes[k];
      step.around[k].motion = motion[k];
      step.springs[k] = axes_[k].evaluate_actuator(axis, step.axes[k], step.around[k], keep);
      step.softening[k] = deflection(step, k, motion[k]) - axis.spring_force / axes_[k].stiffness();
      step.push[k] = axis.spring_force;
    }
  }

  /// Friction of the bearing, torque of each actuator about the other angle, and what the vehicle's own rotation adds, its
  /// mean `turned` [rad] and `rate` [rad/s]. Returns the torques on the vehicle's side of the gimbal [N m].
  Both turn(const State& state, const Both& turned, const Both& rate, Step& step, Keep keep) const noexcept {
    // The first pass goes by the last step's friction: the second solves for speed and torque together, from a velocity
    // without friction that does not depend on it.
    if (keep == Keep::yes) {
      slide(state, step, rate);
    }
    const Pair<S>& friction = state.gimbal.torque;
    const Pose<S>& pose = step.pose;
    const S across_pitch =
        bearing_.pitch_misalignment * step.thrust - step.torque[0] - pose.arm[1][0] * state.axes[1].spring_force;
    const S across_yaw =
        bearing_.yaw_misalignment * step.thrust - step.torque[1] - pose.arm[0][1] * state.axes[0].spring_force;
    return {turn_axis(state, step, 0, turned[0], rate[0], friction.pitch, across_pitch, keep),
            turn_axis(state, step, 1, turned[1], rate[1], friction.yaw, across_yaw, keep)};
  }

  /// Closes a step with the inputs of the last evaluation.
  void finish(const State& state, Step& step) const noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      axes_[k].finish(state.axes[k], step.axes[k]);
    }
    spring_.finish(state.gimbal.bearing, step.bearing, bearing_force(step), state.gimbal.torque);
  }

  /// At rest under forces of the load springs, with the structure's motion at the attach points and rotation at the gimbal:
  /// what the rest of the vehicle is to the axes. `thrust` is beyond the declared one [N].
  void couple_at_rest(const State& state, const Both& forces, const Both& moved, const Both& turned, const S& thrust,
                      std::span<Coupling<S>, 2> around) const {
    const Both angles{state.axes[0].y(AxisModel::kAngle), state.axes[1].y(AxisModel::kAngle)};
    const Pose<S> pose = geometry_.at(angles[0], angles[1]);
    const S own_thrust = bearing_.thrust + thrust;
    const Both misalignment{bearing_.pitch_misalignment, bearing_.yaw_misalignment};
    state.gimbal.bearing = spring_.settled(pushed(pose, own_thrust, forces));
    const Vector3<S> moved_bearing = state.gimbal.bearing.translation();
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& parameters = axes_[k].parameters();
      around[k].motion = pose.stroke[k] - parameters.actuator.moment_arm * angles[k] + moved[k] +
                         dot<S>(pose.direction[k], moved_bearing) + further_flexibility(k, own_thrust) * forces[k];
      around[k].arm = pose.arm[k][k];
      around[k].torque = misalignment[k] * own_thrust - pose.arm[1 - k][k] * state.axes[1 - k].spring_force -
                         parameters.engine.duct_stiffness * turned[k];
      around[k].other_angle = angles[1 - k];
    }
  }

 private:
  /// Force on the bearing: its thrust and dead load, the push of the actuators and a disturbance.
  Vector3<S> bearing_force(const Step& step) const noexcept {
    return pushed(step.pose, step.thrust, step.push) + step.force;
  }
  Vector3<S> pushed(const Pose<S>& pose, const S& thrust, const Both& forces) const noexcept {
    return pose.thrust * (thrust + bearing_.dead_load) + pose.direction[0] * forces[0] + pose.direction[1] * forces[1];
  }

  /// What an attach point gives way by beyond its declared stiffness under a thrust [m/N].
  S further_flexibility(std::size_t k, const S& thrust) const noexcept {
    return bearing_.further_structure(thrust) / axes_[k].parameters().structure.stiffness;
  }

  /// Mean deflection of a load spring before its effects.
  S deflection(const Step& step, std::size_t k, const S& motion) const noexcept {
    return step.axes[k].mean(AxisModel::kPiston) -
           axes_[k].parameters().actuator.moment_arm * step.axes[k].mean(AxisModel::kAngle) - motion;
  }

  S turn_axis(const State& state, Step& step, std::size_t k, const S& turned, const S& rate, const S& friction,
              const S& across, Keep keep) const noexcept {
    const Engine<S>& engine = axes_[k].parameters().engine;
    const S of_vehicle = engine.duct_stiffness * turned + engine.viscous_damping * rate;
    const S of_engine = engine.duct_stiffness * step.axes[k].mean(AxisModel::kAngle) +
                        engine.viscous_damping * step.axes[k].rate(AxisModel::kAngle, h_);
    step.around[k].torque = friction + across - of_vehicle;
    const auto& other = step.axes[1 - k];
    step.around[k].other_angle = other.mean(AxisModel::kAngle);
    step.around[k].other_rate = other.rate(AxisModel::kAngle, h_);
    axes_[k].evaluate_engine(state.axes[k], step.axes[k], step.springs[k], step.around[k], keep);
    return friction + of_engine - of_vehicle;
  }

  /// Friction of the bearing under the slip that the axes' predictions lead to: advances torque and bristle.
  void slide(const State& state, const Step& step, const Both& rate) const noexcept {
    GimbalState<S>& own = state.gimbal;
    const Pair<S> engine{step.axes[0].rate(AxisModel::kAngle, h_), step.axes[1].rate(AxisModel::kAngle, h_)};
    const Vector3<S> force = bearing_force(step);
    const Pair<S> torsion = spring_.rotation_rate(own.bearing, step.bearing, force, own.torque);
    Slip<S> slip;
    slip.h = h_;
    slip.velocity = engine - Pair<S>{rate[0], rate[1]} - torsion + step.vibration;
    slip.compliance = slip_compliance_;
    slip.free_velocity = slip.velocity + slip.compliance.times(own.torque);
    own.torque = friction_.torque(own.bristle, slip, {norm<S>(force), step.vibrating});
  }

  double h_;
  std::array<AxisModel, 2> axes_;
  EngineGeometry<S> geometry_;
  Bearing spring_;
  BearingFriction<S> friction_;
  BearingVibration<S> vibration_;
  GimbalBearing<S> bearing_;
  Pose<S> upright_;  ///< at zero angles
  SymmetricPair<S> slip_compliance_{};
  bool vibrates_;
};

}  // namespace hotfire::model
