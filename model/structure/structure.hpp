// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <numbers>
#include <type_traits>

#include "model/numerics/lanes.hpp"
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
      const ModeMotion<S> from_force{(1.0 - from_displacement.displacement) / (w * w),
                                     -from_displacement.velocity / (w * w)};
      from_displacement_.set(mode, from_displacement);
      from_velocity_.set(mode, from_velocity);
      from_force_.set(mode, from_force);
      held_ += table_.shape.col(k) * table_.shape.col(k).transpose() * from_force.displacement;
    }
    for (int i = 0; i < Ports; ++i) {
      for (int j = 0; j < Ports; ++j) {
        has_residual_ = has_residual_ || anywhere(value_of(table_.residual(i, j)) != 0.0);
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
    for (int first = 0; first < table_.modes; first += kRows) {
      for (int k = first; k < first + kRows; k += kTogether) {
        const ModeMotion<Modes> from = motion(state, k);
        put(row(from_displacement_.displacement, k) * from.displacement +
                row(from_velocity_.displacement, k) * from.velocity,
            k, advance.modes);
      }
      // Two modes at a time: the sum is loaded and stored half as often.
      for (int k = first; k < first + kRows; k += 2) {
        free += table_.shape.col(k) * advance.modes(k) + table_.shape.col(k + 1) * advance.modes(k + 1);
      }
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
    for (int k = 0; k < table_.modes; k += kRows) {
      const Eigen::Matrix<S, 2, 1> force = modal_forces(state.forces, k);
      if constexpr (kInLanes) {
        const Eigen::Matrix<S, 2, 1> next = modal_forces(state.forces, k + 2);
        advance_under(state, advance, k, side_by_side([&](int i) { return i < 2 ? force(i) : next(i - 2); }));
      } else {
        advance_under(state, advance, k, force(0));
        advance_under(state, advance, k + 1, force(1));
      }
    }
    state.displacement = advance.free;
    add_product<Ports, 0>(state.displacement, held_, state.forces);
    state.residual = HalfVector::Zero();
    if (has_residual_) {
      add_product<kHalf, Ports - kHalf>(state.residual, table_.residual, state.forces);
    }
  }

 private:
  /// Displacement and velocity of every mode at the end of a step per unit of something at its start.
  struct ModeSteps {
    std::array<S, Capacity> displacement{};
    std::array<S, Capacity> velocity{};

    void set(std::size_t mode, const ModeMotion<S>& end) noexcept {
      displacement[mode] = end.displacement;
      velocity[mode] = end.velocity;
    }
  };

  // Modes in plain numbers are advanced by several at once, side by side in lanes. A step computes `kRows` rows of the table
  // together; those beyond the last mode are zero.
  static constexpr bool kInLanes = kHasRegistersOfLanes && std::is_same_v<S, double> && Capacity % 4 == 0;
  static constexpr int kTogether = kInLanes ? 4 : 1;
  static constexpr int kRows = kInLanes ? 4 : 2;
  static_assert(Capacity % kRows == 0);
  using Modes = std::conditional_t<kInLanes, Lanes<4>, S>;

  /// `of(0)`, or that of as many modes as are advanced at once.
  template <class F>
  static Modes side_by_side(const F& of) noexcept {
    if constexpr (kInLanes) {
      return Modes::by_lane(of);
    } else {
      return of(0);
    }
  }

  /// Row k of what has a number for every mode, or the rows from k on.
  template <class Rows>
  static Modes row(const Rows& values, int k) noexcept {
    if constexpr (kInLanes) {
      return Modes::load(values.data() + k);
    } else {
      return values.data()[k];
    }
  }
  static void put(const Modes& numbers, int k, Eigen::Matrix<S, Capacity, 1>& values) noexcept {
    if constexpr (kInLanes) {
      numbers.store(values.data() + k);
    } else {
      values(k) = numbers;
    }
  }

  static ModeMotion<Modes> motion(const State& state, int k) noexcept {
    const ModeMotion<S>* modes = state.modes.data() + k;
    return {side_by_side([&](int i) { return modes[i].displacement; }),
            side_by_side([&](int i) { return modes[i].velocity; })};
  }
  static void set_motion(State& state, int k, const ModeMotion<Modes>& to) noexcept {
    ModeMotion<S>* modes = state.modes.data() + k;
    if constexpr (kInLanes) {
      for (int lane = 0; lane < kTogether; ++lane) {
        modes[lane] = {to.displacement[lane], to.velocity[lane]};
      }
    } else {
      *modes = to;
    }
  }

  /// Closes the step of the modes from row k on that are advanced at once.
  void advance_under(State& state, const Advance& advance, int k, const Modes& force) const noexcept {
    const ModeMotion<Modes> from = motion(state, k);
    set_motion(state, k,
               {row(advance.modes, k) + row(from_force_.displacement, k) * force,
                row(from_displacement_.velocity, k) * from.displacement + row(from_velocity_.velocity, k) * from.velocity +
                    row(from_force_.velocity, k) * force});
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

  /// Adds rows First to First + Rows of matrix * vector. Rows are summed side by side, as many as a register may hold.
  template <int Rows, int First, int MatrixRows>
  static void add_product(Eigen::Matrix<S, Rows, 1>& total, const Eigen::Matrix<S, MatrixRows, Ports>& matrix,
                          const PortVector& vector) noexcept {
    constexpr int kRowsTogether = Rows % 4 == 0 ? 4 : 2;
    for (int row = 0; row + kRowsTogether <= Rows; row += kRowsTogether) {
      Eigen::Matrix<S, kRowsTogether, 1> sum = total.template segment<kRowsTogether>(row);
      for (int column = 0; column < Ports; ++column) {
        sum += matrix.template block<kRowsTogether, 1>(First + row, column) * vector(column);
      }
      total.template segment<kRowsTogether>(row) = sum;
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
  ModeSteps from_displacement_;
  ModeSteps from_velocity_;
  ModeSteps from_force_;                  ///< held over the step
  PortMatrix held_ = PortMatrix::Zero();  ///< H
  PortMatrix mean_flexibility_;
  RateMatrix rate_flexibility_;
};

}  // namespace hotfire::model
