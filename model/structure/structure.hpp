// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <numbers>

#include "model/structure/mode.hpp"

namespace hotfire::model {

/// The modes of a vehicle whose engines swing freely on their gimbals and whose actuators are taken out, in the order of the
/// table's rows. Such modes are orthogonal to the swinging of the engines by the mass matrix, so that they meet actuators
/// and bearings through displacements and forces alone.
///
/// A port is a displacement that something outside works on; its shape is the displacement of a mode there. Ports of an
/// actuator: how far the mode pulls its two attach points towards each other along its line [kg^-0.5]. Ports of a gimbal:
/// rotation of the vehicle's side against the engine, about pitch and yaw [rad/(m kg^0.5)].
template <class S, int Ports, int Capacity>
struct ModeTable {
  static constexpr int kPorts = Ports;
  static constexpr int kCapacity = Capacity;
  int modes = 0;                                                                        ///< rows in use
  std::array<S, Capacity> frequency{};                                                  ///< natural frequency [Hz], above 0
  std::array<S, Capacity> damping_ratio{};                                              ///< 0 or more
  Eigen::Matrix<S, Ports, Capacity> shape = Eigen::Matrix<S, Ports, Capacity>::Zero();  ///< a column a mode
  Eigen::Matrix<S, Ports, Ports> residual = Eigen::Matrix<S, Ports, Ports>::Zero();     ///< symmetric, no mode of its own
};

/// Modal structure, physics.md section 2:
///   eta'' + 2 zeta w eta' + w^2 eta = Phi^T f,   p = Phi eta + residual f.
///
/// Each mode is advanced exactly under the force's mean over the step, held (a 2x2 block), so it is right at any frequency
/// and step for what it is given; the mean force makes the whole second order. Over one step the ports then are
///   p(end) = p_free + H f,   mean p = (p(start) + p_free) / 2 + (H / 2 + residual) f,
/// with constant symmetric H: what works on the ports can be solved together with them.
///
/// Cost per step is linear in the modes. No allocation; `State` is flat.
/// [Hurty and Rubinstein 1964] Dynamics of Structures, ch. 8; residual flexibility: [MacNeal 1971] Computers & Structures 1.
template <class S, int Ports, int Capacity>
class ModalStructure {
 public:
  using Table = ModeTable<S, Ports, Capacity>;
  using PortVector = Eigen::Matrix<S, Ports, 1>;
  using PortMatrix = Eigen::Matrix<S, Ports, Ports>;

  /// Half of the ports: all attach points, or all rotations of gimbals. Of an odd number the rotations are the smaller part.
  static constexpr int kHalf = Ports / 2;
  using HalfVector = Eigen::Matrix<S, kHalf, 1>;
  using RateMatrix = Eigen::Matrix<S, kHalf, Ports>;

  struct State {
    std::array<ModeMotion<S>, Capacity> modes{};
    PortVector displacement = PortVector::Zero();  ///< Phi eta at the end of the last step
    HalfVector residual = HalfVector::Zero();      ///< residual f of the rotations, mean of the last step
    PortVector forces = PortVector::Zero();        ///< f, mean of the last step, or what the present step has found so far
  };

  /// One step under way: what does not depend on the forces that it will find.
  struct Advance {
    Eigen::Matrix<S, Capacity, 1> modes;  ///< eta at its end without force
    PortVector free;                      ///< Phi eta at its end without force
    PortVector mean;                      ///< mean displacement without force
    HalfVector rate;                      ///< mean rate of the rotations without force
  };

  ModalStructure(const Table& table, double h) : table_(table), h_(h) {
    for (int k = 0; k < table_.modes; ++k) {
      const auto mode = static_cast<std::size_t>(k);
      const S w = table_.frequency[mode] * (2.0 * std::numbers::pi);
      const ModeMotion<S> from_displacement = advance_mode<S>({S(1.0), S(0.0)}, w, table_.damping_ratio[mode], h);
      const ModeMotion<S> from_velocity = advance_mode<S>({S(0.0), S(1.0)}, w, table_.damping_ratio[mode], h);
      steps_[mode] = {from_displacement,
                      from_velocity,
                      {(1.0 - from_displacement.displacement) / (w * w), -from_displacement.velocity / (w * w)}};
      held_ += table_.shape.col(k) * table_.shape.col(k).transpose() * steps_[mode].from_force.displacement;
    }
    for (int i = 0; i < Ports; ++i) {
      for (int j = 0; j < Ports; ++j) {
        has_residual_ = has_residual_ || value_of(table_.residual(i, j)) != 0.0;
      }
    }
    mean_flexibility_ = S(0.5) * held_ + table_.residual;
    rate_flexibility_ = (held_ + table_.residual).template bottomRows<kHalf>() / S(h);
  }

  const Table& table() const noexcept { return table_; }

  /// Mean displacement of the ports over a step per mean force.
  const PortMatrix& mean_flexibility() const noexcept { return mean_flexibility_; }

  /// Mean rate of the rotations over a step per mean force on any port.
  const RateMatrix& rate_flexibility() const noexcept { return rate_flexibility_; }

  /// Flexibility of the ports at rest: sum of phi phi^T / w^2 over the modes, and the residual. Set-up only.
  PortMatrix static_flexibility() const {
    PortMatrix sum = table_.residual;
    for (int k = 0; k < table_.modes; ++k) {
      const S w = table_.frequency[static_cast<std::size_t>(k)] * (2.0 * std::numbers::pi);
      sum += table_.shape.col(k) * table_.shape.col(k).transpose() / (w * w);
    }
    return sum;
  }

  /// At rest under constant forces: set-up only.
  State settled(const PortVector& forces) const {
    State state;
    state.forces = forces;
    for (int k = 0; k < table_.modes; ++k) {
      const auto mode = static_cast<std::size_t>(k);
      const S w = table_.frequency[mode] * (2.0 * std::numbers::pi);
      state.modes[mode].displacement = modal_forces(forces, k - k % 2)(k % 2) / (w * w);
    }
    for (int k = 0; k < table_.modes; ++k) {
      state.displacement += table_.shape.col(k) * state.modes[static_cast<std::size_t>(k)].displacement;
    }
    add_product<kHalf, Ports - kHalf>(state.residual, table_.residual, forces);
    return state;
  }

  Advance begin(const State& state) const noexcept {
    Advance advance;
    begin(state, advance);
    return advance;
  }
  void begin(const State& state, Advance& advance) const noexcept {
    PortVector free = PortVector::Zero();
    // Two modes at a time: the sum is loaded and stored half as often. Rows beyond the last are zero.
    for (int k = 0; k < table_.modes; k += 2) {
      const auto mode = static_cast<std::size_t>(k);
      advance.modes(k) = free_end(state, mode);
      advance.modes(k + 1) = free_end(state, mode + 1);
      free += table_.shape.col(k) * advance.modes(k) + table_.shape.col(k + 1) * advance.modes(k + 1);
    }
    const HalfVector turned = (free - state.displacement).template tail<kHalf>();
    advance.free = free;
    advance.mean = S(0.5) * (state.displacement + free);
    advance.rate = (turned - state.residual) / S(h_);
  }

  /// Mean displacement of the attach points under the forces in `state`.
  HalfVector attach_motion(const State& state, const Advance& advance) const noexcept {
    HalfVector sum = advance.mean.template head<kHalf>();
    add_product<kHalf, 0>(sum, mean_flexibility_, state.forces);
    return sum;
  }

  /// Mean rotation of the vehicle's side of the gimbals under the forces in `state`, and its mean rate.
  HalfVector rotation(const State& state, const Advance& advance) const noexcept {
    HalfVector sum = advance.mean.template tail<kHalf>();
    add_product<kHalf, Ports - kHalf>(sum, mean_flexibility_, state.forces);
    return sum;
  }
  HalfVector rotation_rate(const State& state, const Advance& advance) const noexcept {
    HalfVector sum = advance.rate;
    add_product<kHalf, 0>(sum, rate_flexibility_, state.forces);
    return sum;
  }

  /// Closes a step under the forces in `state`.
  void finish(State& state, const Advance& advance) const noexcept {
    for (int k = 0; k < table_.modes; k += 2) {
      const Eigen::Matrix<S, 2, 1> force = modal_forces(state.forces, k);
      const auto mode = static_cast<std::size_t>(k);
      advance_under(state, mode, advance.modes(k), force(0));
      advance_under(state, mode + 1, advance.modes(k + 1), force(1));
    }
    state.displacement = advance.free;
    add_product<Ports, 0>(state.displacement, held_, state.forces);
    state.residual = HalfVector::Zero();
    if (has_residual_) {
      add_product<kHalf, Ports - kHalf>(state.residual, table_.residual, state.forces);
    }
  }

 private:
  struct ModeStep {
    ModeMotion<S> from_displacement;
    ModeMotion<S> from_velocity;
    ModeMotion<S> from_force;
  };

  S free_end(const State& state, std::size_t mode) const noexcept {
    return steps_[mode].from_displacement.displacement * state.modes[mode].displacement +
           steps_[mode].from_velocity.displacement * state.modes[mode].velocity;
  }

  void advance_under(State& state, std::size_t mode, const S& free, const S& force) const noexcept {
    const ModeStep& step = steps_[mode];
    const ModeMotion<S> from = state.modes[mode];
    state.modes[mode] = {free + step.from_force.displacement * force, step.from_displacement.velocity * from.displacement +
                                                                          step.from_velocity.velocity * from.velocity +
                                                                          step.from_force.velocity * force};
  }

  /// Generalised forces on modes k and k + 1. Sums run in pairs of ports, so that the order of additions is the same
  /// whatever instruction set a compiler has.
  Eigen::Matrix<S, 2, 1> modal_forces(const PortVector& forces, int k) const noexcept {
    static_assert(Capacity % 2 == 0);
    const auto part = [&](int port, int mode) {
      return table_.shape.template block<2, 1>(port, mode).cwiseProduct(forces.template segment<2>(port));
    };
    Eigen::Matrix<S, 2, 1> first = part(0, k);
    Eigen::Matrix<S, 2, 1> second = part(0, k + 1);
    for (int port = 2; port + 1 < Ports; port += 2) {
      first += part(port, k);
      second += part(port, k + 1);
    }
    if constexpr (Ports % 2 == 1) {
      first(0) += table_.shape(Ports - 1, k) * forces(Ports - 1);
      second(0) += table_.shape(Ports - 1, k + 1) * forces(Ports - 1);
    }
    return {first(0) + first(1), second(0) + second(1)};
  }

  /// Adds rows First to First + Rows of matrix * vector.
  template <int Rows, int First, int MatrixRows>
  static void add_product(Eigen::Matrix<S, Rows, 1>& total, const Eigen::Matrix<S, MatrixRows, Ports>& matrix,
                          const PortVector& vector) noexcept {
    for (int row = 0; row + 1 < Rows; row += 2) {
      Eigen::Matrix<S, 2, 1> sum = total.template segment<2>(row);
      for (int column = 0; column < Ports; ++column) {
        sum += matrix.template block<2, 1>(First + row, column) * vector(column);
      }
      total.template segment<2>(row) = sum;
    }
    if constexpr (Rows % 2 == 1) {
      for (int column = 0; column < Ports; ++column) {
        total(Rows - 1) += matrix(First + Rows - 1, column) * vector(column);
      }
    }
  }

  Table table_;
  double h_;
  bool has_residual_ = false;
  std::array<ModeStep, Capacity> steps_{};
  PortMatrix held_ = PortMatrix::Zero();  ///< H
  PortMatrix mean_flexibility_;
  RateMatrix rate_flexibility_;
};

}  // namespace hotfire::model
