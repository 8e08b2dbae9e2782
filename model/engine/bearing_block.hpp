// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>

#include "model/engine/gimbal_spring.hpp"
#include "model/numerics/exact_hold.hpp"
#include "model/structure/structure.hpp"

namespace hotfire::model {

/// The modes of the block between the halves of a bearing, on the vehicle's half; none without a block. Ports: translation
/// along x, y, z and rotation about y (pitch) and z (yaw), against the vehicle. The block solves
///   M u'' + K_v (u + loss_time u') = (N, T),   K_v = stiffness / vehicle_side_flexibility,
/// M being `block_mass` along x, y, z and `block_inertia` about y and z. Rotation about x has no inertia and no torque: it
/// follows the other five, and nothing follows it. With C their compliance and C = L L^T, the eigenvectors q and values 1 /
/// w^2 of L^T M L give the modes L q w, which are mass-normalised and have the damping ratio loss_time w / 2.
template <class S>
ModeTable<S, 5, 6> block_modes(const GimbalParameters<S>& gimbal) {
  ModeTable<S, 5, 6> table;
  if (!gimbal.has_block()) {
    return table;
  }
  constexpr int kMoving = 5;
  constexpr std::array<int, kMoving> kPlaces{0, 1, 2, 4, 5};
  const GimbalBearing<S>& bearing = gimbal.bearing;
  const std::array<S, kMoving> inertia{bearing.block_mass, bearing.block_mass, bearing.block_mass, bearing.block_inertia,
                                       bearing.block_inertia};
  const Eigen::Matrix<S, 6, 6> whole = inverse_of_positive_definite<S, 6>(gimbal.stiffness);
  Eigen::Matrix<S, kMoving, kMoving> compliance;
  for (int j = 0; j < kMoving; ++j) {
    for (int i = 0; i < kMoving; ++i) {
      compliance(i, j) = bearing.vehicle_side_flexibility *
                         whole(kPlaces[static_cast<std::size_t>(i)], kPlaces[static_cast<std::size_t>(j)]);
    }
  }
  Eigen::Matrix<S, kMoving, kMoving> factor;
  factorise<S, kMoving>(compliance, factor);
  Eigen::Matrix<S, kMoving, kMoving> carried = Eigen::Matrix<S, kMoving, kMoving>::Zero();
  for (int i = 0; i < kMoving; ++i) {
    for (int j = 0; j < kMoving; ++j) {
      for (int k = 0; k < kMoving; ++k) {
        carried(i, j) += factor(k, i) * inertia[static_cast<std::size_t>(k)] * factor(k, j);
      }
    }
  }
  const Eigensystem<S, kMoving> modes = eigensystem_of_symmetric<S, kMoving>(carried);
  table.modes = kMoving;
  for (int k = 0; k < kMoving; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const S w = 1.0 / sqrt(modes.values(k));
    table.frequency[mode] = w / (2.0 * std::numbers::pi);
    table.damping_ratio[mode] = 0.5 * bearing.loss_time * w;
    const Eigen::Matrix<S, kMoving, 1> direction = modes.vectors.col(k);
    table.shape.col(k) = times<S, kMoving, kMoving>(factor, direction) * w;
  }
  return table;
}

/// How a bearing moves: its engine's half as a spring with loss (`GimbalSpring`), and its block on the vehicle's half, both
/// under the force through the joint and the torque of its friction. The block's modes are advanced as those of the
/// structure are (`ModalStructure`): exactly under the mean wrench of a step, with the mean of both ends as mean
/// displacement. Without a block the spring is the whole bearing, and nothing else is evaluated.
///
/// The motion of the vehicle's side of the gimbal does not accelerate the block: the modes of the vehicle contain the block
/// as a part of the mount.
template <class S>
class CompliantBearing {
 public:
  using Six = typename GimbalSpring<S>::Six;
  using Block = ModalStructure<S, 5, 6>;
  using Advance = typename Block::Advance;  ///< of the block; unset without one

  struct State {
    Six displacement = Six::Zero();  ///< of the engine's half against the block, or against the vehicle if there is none
    typename Block::State block{};   ///< against the vehicle

    /// Of the engine's half against the vehicle.
    Vector3<S> translation() const noexcept {
      return displacement.template head<3>() + block.displacement.template head<3>();
    }
    Pair<S> rotation() const noexcept {
      return {displacement(4) + block.displacement(3), displacement(5) + block.displacement(4)};
    }
  };

  CompliantBearing(const GimbalParameters<S>& gimbal, double h) : CompliantBearing(gimbal, block_modes(gimbal), h) {}

  /// With the modes of its block, which depend on the parameters.
  CompliantBearing(const GimbalParameters<S>& gimbal, const typename Block::Table& modes, double h)
      : spring_(gimbal, h), block_(modes, h) {
    if (has_block()) {
      spring_.add_rate_flexibility(block_.rate_flexibility());
    }
  }

  bool has_block() const noexcept { return block_.table().modes > 0; }

  /// Opens a step.
  void begin(const State& state, Advance& advance) const noexcept {
    if (has_block()) {
      begin_block(state, advance);
    }
  }

  /// Mean translation over the step under a force and a torque about pitch (y) and yaw (z).
  Vector3<S> mean_translation(const State& state, const Advance& advance, const Vector3<S>& force,
                              const Pair<S>& torque) const noexcept {
    Vector3<S> mean = spring_.mean_translation(state.displacement, force, torque);
    if (has_block()) {
      add_translation_of_block(advance, force, torque, mean);
    }
    return mean;
  }

  /// Mean rate of rotation over the step.
  Pair<S> rotation_rate(const State& state, const Advance& advance, const Vector3<S>& force,
                        const Pair<S>& torque) const noexcept {
    Pair<S> rate = spring_.rotation_rate(state.displacement, force, torque);
    if (has_block()) {
      rate.pitch += advance.rate(0);
      rate.yaw += advance.rate(1);
    }
    return rate;
  }

  /// Closes the step.
  void finish(State& state, const Advance& advance, const Vector3<S>& force, const Pair<S>& torque) const noexcept {
    state.displacement = spring_.end(state.displacement, force, torque);
    if (has_block()) {
      finish_block(state, advance, force, torque);
    }
  }

  /// Where a force would bring the bearing to rest. Set-up only.
  State settled(const Vector3<S>& force) const {
    State state;
    state.displacement = spring_.settled(force, {});
    if (has_block()) {
      load(state, force, {});
      state.block = block_.settled(state.block.forces);
    }
    return state;
  }

  /// Mean displacement along one direction per mean force along another, under a load.
  S mean_flexibility(const Vector3<S>& along, const Vector3<S>& force, const Vector3<S>& load) const noexcept {
    S flexibility = spring_.mean_flexibility(along, force, load);
    if (has_block()) {
      flexibility += mean_flexibility_of_block(along, force);
    }
    return flexibility;
  }

  /// Mean rate of rotation per mean torque.
  SymmetricPair<S> rate_flexibility() const noexcept { return spring_.rate_flexibility(); }

 private:
  // The functions of a block are not inlined. Inlined, they would keep the compiler from inlining the rest of a step.

  [[gnu::noinline]] void begin_block(const State& state, Advance& advance) const noexcept {
    block_.begin(state.block, advance);
  }

  [[gnu::noinline]] void add_translation_of_block(const Advance& advance, const Vector3<S>& force, const Pair<S>& torque,
                                                  Vector3<S>& mean) const noexcept {
    const auto& flexibility = block_.mean_flexibility();
    for (int i = 0; i < 3; ++i) {
      mean(i) += advance.mean(i) + under(flexibility, i, force, torque);
    }
  }

  [[gnu::noinline]] void finish_block(State& state, const Advance& advance, const Vector3<S>& force,
                                      const Pair<S>& torque) const noexcept {
    load(state, force, torque);
    block_.finish(state.block, advance);
  }

  [[gnu::noinline]] S mean_flexibility_of_block(const Vector3<S>& along, const Vector3<S>& force) const noexcept {
    const auto& of_block = block_.mean_flexibility();
    S sum{0.0};
    for (int i = 0; i < 3; ++i) {
      sum += along(i) * (of_block(i, 0) * force(0) + of_block(i, 1) * force(1) + of_block(i, 2) * force(2));
    }
    return sum;
  }

  /// One row of a matrix times the wrench.
  template <class Matrix>
  static S under(const Matrix& matrix, int row, const Vector3<S>& force, const Pair<S>& torque) noexcept {
    return matrix(row, 0) * force(0) + matrix(row, 1) * force(1) + matrix(row, 2) * force(2) +
           matrix(row, 3) * torque.pitch + matrix(row, 4) * torque.yaw;
  }

  static void load(State& state, const Vector3<S>& force, const Pair<S>& torque) noexcept {
    state.block.forces << force(0), force(1), force(2), torque.pitch, torque.yaw;
  }

  GimbalSpring<S> spring_;
  Block block_;
};

}  // namespace hotfire::model
