// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/vehicle.hpp"

namespace hotfire::model {

// The set-up of a vehicle, and where its forces balance: at rest, and within one pass of a step. The members of `Vehicle`
// that are not its passes; vehicle.hpp says what they do.

template <class S, int Engines, int Capacity, class List>
Vehicle<S, Engines, Capacity, List>::Vehicle(const Parameters& parameters, double h)
    : h_(h),
      axes_(axes_of(parameters, h, std::make_index_sequence<kAxes>{})),
      structure_(parameters.modes, h),
      gimbals_(gimbals_of(parameters, h, std::make_index_sequence<Engines>{})) {
  std::array<S, Engines> thrust{};
  for (int e = 0; e < Engines; ++e) {
    const GimbalBearing<S>& bearing = gimbals_[at(e)].bearing;
    thrust[at(e)] = bearing.thrust;
    stiffens_ = stiffens_ || value_of(bearing.unloaded_structure) < 1.0 || value_of(bearing.unloaded_stiffness) < 1.0;
  }
  give_ = give_under(thrust);
}

template <class S, int Engines, int Capacity, class List>
typename Vehicle<S, Engines, Capacity, List>::State Vehicle<S, Engines, Capacity, List>::steady(
    const std::array<S, kAxes>& commands, const std::array<S, Engines>& thrust) const {
  constexpr int kRounds = 60;  // each shrinks the change by K_n / (R^2 K_L), 1e-2, or the change of the arms, 1e-1
  State state;
  std::array<Coupling<S>, kAxes> around{};
  for (int i = 0; i < kAxes; ++i) {
    around[at(i)].arm = axes_[at(i)].parameters().actuator.moment_arm;
  }
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kAxes; ++i) {
      state.axes[at(i)] = axes_[at(i)].settled(commands[at(i)], around[at(i)]);
    }
    couple_at_rest(state, around, thrust);
  }
  for (int i = 0; i < kAxes; ++i) {
    const auto& axis = axes_[at(i)];
    const S deflection = state.axes[at(i)].y(AxisModel::kPiston) -
                         axis.parameters().actuator.moment_arm * state.axes[at(i)].y(AxisModel::kAngle) -
                         around[at(i)].motion;
    state.softening[at(i)] = deflection - state.axes[at(i)].spring_force / axis.stiffness();
  }
  gather(state);
  return state;
}

template <class S, int Engines, int Capacity, class List>
void Vehicle<S, Engines, Capacity, List>::couple_at_rest(State& state, std::array<Coupling<S>, kAxes>& around,
                                                         const std::array<S, Engines>& thrust) const {
  typename Structure::PortVector forces = Structure::PortVector::Zero();
  const auto flexibility = structure_.static_flexibility();
  const auto turned = [&] { return typename Structure::PortVector(flexibility * state.structure.forces); }();
  for (int i = 0; i < kAxes; ++i) {
    forces(i) = state.axes[at(i)].spring_force;
    forces(kAxes + i) =
        axes_[at(i)].parameters().engine.duct_stiffness * (state.axes[at(i)].y(AxisModel::kAngle) - turned(kAxes + i));
  }
  state.structure = structure_.settled(forces);
  const typename Structure::PortVector moved = flexibility * forces;
  for (int e = 0; e < Engines; ++e) {
    const Gimbal& gimbal = gimbals_[at(e)];
    const std::array<S, 2> angles{state.axes[at(2 * e)].y(AxisModel::kAngle),
                                  state.axes[at(2 * e + 1)].y(AxisModel::kAngle)};
    const Pose<S> pose = gimbal.geometry.at(angles[0], angles[1]);
    const S own_thrust = gimbal.bearing.thrust + thrust[at(e)];
    const std::array<S, 2> misalignment{gimbal.bearing.pitch_misalignment, gimbal.bearing.yaw_misalignment};
    state.gimbals[at(e)].bearing = gimbal.spring.settled(pushed(state, pose, own_thrust, e));
    const Vector3<S> moved_bearing = state.gimbals[at(e)].bearing.translation();
    for (int k = 0; k < 2; ++k) {
      const int i = 2 * e + k;
      const auto& parameters = axes_[at(i)].parameters();
      around[at(i)].motion = pose.stroke[at(k)] - parameters.actuator.moment_arm * angles[at(k)] + moved(i) +
                             dot<S>(pose.direction[at(k)], moved_bearing) + further_flexibility(i, own_thrust) * forces(i);
      around[at(i)].arm = pose.arm[at(k)][at(k)];
      around[at(i)].torque = misalignment[at(k)] * own_thrust -
                             pose.arm[at(1 - k)][at(k)] * state.axes[at(2 * e + 1 - k)].spring_force -
                             parameters.engine.duct_stiffness * moved(kAxes + i);
      around[at(i)].other_angle = angles[at(1 - k)];
    }
  }
}

template <class S, int Engines, int Capacity, class List>
typename Vehicle<S, Engines, Capacity, List>::Give Vehicle<S, Engines, Capacity, List>::give_under(
    const std::array<S, Engines>& thrust) const noexcept {
  Give give;
  give.flexibility = structure_.mean_flexibility().template topLeftCorner<kAxes, kAxes>();
  for (int e = 0; e < Engines; ++e) {
    const Gimbal& gimbal = gimbals_[at(e)];
    const Vector3<S> load = gimbal.upright.thrust * (thrust[at(e)] + gimbal.bearing.dead_load);
    const auto& direction = gimbal.upright.direction;
    const S pitch = gimbal.spring.mean_flexibility(direction[0], direction[0], load);
    const S yaw = gimbal.spring.mean_flexibility(direction[1], direction[1], load);
    const S cross = gimbal.spring.mean_flexibility(direction[0], direction[1], load);
    give.flexibility(2 * e, 2 * e) += pitch + further_flexibility(2 * e, thrust[at(e)]);
    give.flexibility(2 * e + 1, 2 * e + 1) += yaw + further_flexibility(2 * e + 1, thrust[at(e)]);
    give.flexibility(2 * e, 2 * e + 1) += cross;
    give.flexibility(2 * e + 1, 2 * e) += cross;
  }
  AxisMatrix with_springs = give.flexibility;
  for (int i = 0; i < kAxes; ++i) {
    with_springs(i, i) += 1.0 / axes_[at(i)].stiffness();
  }
  // Positive definite: the springs alone are, and what is added to them gives way.
  factorise<S, kAxes>(with_springs, give.factor);
  return give;
}

}  // namespace hotfire::model
