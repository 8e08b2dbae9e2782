// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "model/declaration/each_number.hpp"
#include "model/effects.hpp"
#include "model/numerics/lanes.hpp"
#include "model/vehicle_engine.hpp"

namespace hotfire::model {

/// True if the engines of a vehicle may step in lanes: the scalar is double, the number of engines is a multiple of four,
/// and every effect of the list has code for lanes.
template <class S, int Engines, class List>
constexpr bool may_run_side_by_side() noexcept {
  return kHasRegistersOfLanes && std::is_same_v<S, double> && Engines % 4 == 0 && std::is_same_v<List, MasvEffects>;
}

/// The engines of a vehicle side by side: an engine is a lane. Every number of a step has the bits that it has with one
/// engine after the other.
template <int Engines, class List>
class EnginesSideBySide {
 public:
  using Number = Lanes<Engines>;
  using Engine = VehicleEngine<Number, List>;
  using PlainEngine = VehicleEngine<double, List>;
  using Parameters = std::array<typename PlainEngine::Parameters, Engines>;

  /// The state of all engines during a step. Its members are not initialised: `take_in` sets all that a step reads, and to
  /// initialise them would double its instructions.
  union State {
    struct Members {
      std::array<typename Engine::AxisModel::State, 2> axes;
      GimbalState<Number> gimbal;
    };
    Members all;

    State() noexcept {}  // NOLINT(cppcoreguidelines-pro-type-member-init,modernize-use-equals-default)
  };

  EnginesSideBySide(const Parameters& parameters, double h)
      : parameters_(parameters),
        engines_{Engine(in_lanes(parameters), block_modes_of(parameters), h)},
        acting_{ActingEffects<List>(parameters[0].axes[0].effects.active),
                ActingEffects<List>(parameters[0].axes[1].effects.active)},
        has_block_(parameters[0].gimbal.has_block()) {}

  /// True if the engines have the same in all that lanes share: the effects of the pitch axes, and of the yaw axes, with
  /// their laws and the number of points of their tables, the law of friction, and what kind of bearing there is.
  static bool are_alike(const Parameters& parameters) noexcept {
    bool alike = true;
    typename Engine::Parameters shared{};
    each_number(
        shared, [&](int lane) -> const auto& { return parameters[at(lane)]; }, CompareShared<Engines>{alike});
    for (const auto& own : parameters) {
      alike = alike && own.gimbal.has_block() == parameters[0].gimbal.has_block() &&
              own.gimbal.vibration.vibrates() == parameters[0].gimbal.vibration.vibrates();
    }
    return alike;
  }

  const std::array<Engine, 1>& engines() const noexcept { return engines_; }
  std::array<Engine, 1>& engines() noexcept { return engines_; }
  const Parameters& parameters() const noexcept { return parameters_; }

  /// Takes the engines of a vehicle's state into their lanes. The clocks of all count the steps of the first.
  template <class VehicleState>
  void take_in(const VehicleState& from, State& own) const noexcept {
    each_of_engines(from, own.all, IntoLanes{});
  }

  /// Gives them back, with the readings of a finished step.
  template <class VehicleState>
  void give_back(const State& own, VehicleState& to) const noexcept {
    each_of_engines(to, own.all, OutOfLanes<Engines>{});
    for (std::size_t k = 0; k < 2; ++k) {
      each_number(
          own.all.axes[k].measured, [&](int lane) -> auto& { return to.axes[2 * at(lane) + k].measured; },
          OutOfLanes<Engines>{});
    }
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  static typename Engine::Parameters in_lanes(const Parameters& parameters) noexcept {
    typename Engine::Parameters lanes{};
    each_number(
        lanes, [&](int lane) -> const auto& { return parameters[at(lane)]; }, IntoLanes{});
    return lanes;
  }

  static typename Engine::Bearing::Block::Table block_modes_of(const Parameters& parameters) {
    std::array<typename PlainEngine::Bearing::Block::Table, Engines> plain;
    for (std::size_t e = 0; e < plain.size(); ++e) {
      plain[e] = block_modes(parameters[e].gimbal);
    }
    typename Engine::Bearing::Block::Table lanes;
    each_number(
        lanes, [&](int lane) -> const auto& { return plain[at(lane)]; }, IntoLanes{});
    return lanes;
  }

  /// Walks through what a step reads of the state of the engines. The effects that do not act keep theirs, and so does a
  /// bearing without a block.
  template <class VehicleState, class Own, class F>
  [[gnu::always_inline]] void each_of_engines(VehicleState& state, Own& own, const F& f) const noexcept {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto axis = [&](int lane) __attribute__((always_inline))->auto& { return state.axes[2 * at(lane) + k]; };
      auto& lanes = own.axes[k];
      each_number(
          lanes.y, [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).y; }, f);
      each_number(
          lanes.inputs, [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).inputs; }, f);
      each_number(
          lanes.spring_force, [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).spring_force; }, f);
      each_number(
          lanes.built_up, [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).built_up; }, f);
      each_number(
          lanes.clock, [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).clock; }, f);
      each_number(
          lanes.effects, acting_[k], [&](int lane) __attribute__((always_inline))->auto& { return axis(lane).effects; }, f);
    }
    const auto gimbal = [&](int lane) __attribute__((always_inline))->auto& { return state.gimbals[at(lane)]; };
    each_number(
        own.gimbal.bearing.displacement,
        [&](int lane) __attribute__((always_inline))->auto& { return gimbal(lane).bearing.displacement; }, f);
    if (has_block_) {
      each_number(
          own.gimbal.bearing.block, [&](int lane) -> auto& { return gimbal(lane).bearing.block; }, f);
    }
    each_number(
        own.gimbal.bristle, [&](int lane) __attribute__((always_inline))->auto& { return gimbal(lane).bristle; }, f);
    each_number(
        own.gimbal.torque, [&](int lane) __attribute__((always_inline))->auto& { return gimbal(lane).torque; }, f);
  }

  Parameters parameters_;
  std::array<Engine, 1> engines_;
  std::array<ActingEffects<List>, 2> acting_;  ///< of the pitch axes, of the yaw axes
  bool has_block_;
};

}  // namespace hotfire::model
