// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/vehicle.hpp"

namespace hotfire::model {

// The set-up of a vehicle, and where its forces balance: at rest, and within one pass of a step. The members of `Vehicle`
// that are not its passes; vehicle.hpp says what they do.

namespace detail {

template <class Engine, std::size_t Engines, std::size_t... I>
std::array<Engine, Engines> engines_alone(const std::array<typename Engine::Parameters, Engines>& parameters, double h,
                                          std::index_sequence<I...>) {
  return {Engine(parameters[I], block_modes(parameters[I].gimbal), h)...};
}

/// Engines that are not in lanes, without the structure.
template <class Engine, std::size_t Engines>
std::array<Engine, Engines> engines_alone(const std::array<typename Engine::Parameters, Engines>& parameters, double h) {
  return engines_alone<Engine>(parameters, h, std::make_index_sequence<Engines>{});
}

}  // namespace detail

template <class S, int Engines, int Capacity, class List>
auto Vehicle<S, Engines, Capacity, List>::form_of(const Parameters& parameters, double h, [[maybe_unused]] Stepping stepping)
    -> Form {
  const EngineParameters own = engine_parameters(parameters);
  if constexpr (kMayRunSideBySide) {
    if (stepping == Stepping::side_by_side && SideBySide::are_alike(own)) {
      return Form(std::in_place_type<SideBySide>, own, h);
    }
  }
  return Form(detail::engines_alone<EngineModel>(own, h));
}

template <class S, int Engines, int Capacity, class List>
template <class F>
auto Vehicle<S, Engines, Capacity, List>::with_engines_alone(const F& f) const {
  if constexpr (kMayRunSideBySide) {
    if (const SideBySide* beside = std::get_if<SideBySide>(&engines_)) {
      return f(detail::engines_alone<EngineModel>(beside->parameters(), h_));
    }
  }
  return f(*std::get_if<Alone>(&engines_));
}

template <class S, int Engines, int Capacity, class List>
auto Vehicle<S, Engines, Capacity, List>::axis(int i) const -> AxisModel {
  if constexpr (kMayRunSideBySide) {
    if (const SideBySide* beside = std::get_if<SideBySide>(&engines_)) {
      return EngineModel::axis_of(beside->parameters()[at(i / 2)], at(i % 2), h_);
    }
  }
  return (*std::get_if<Alone>(&engines_))[at(i / 2)].axis(at(i % 2));
}

template <class S, int Engines, int Capacity, class List>
EngineGeometry<S> Vehicle<S, Engines, Capacity, List>::geometry(int engine) const {
  if constexpr (kMayRunSideBySide) {
    if (const SideBySide* beside = std::get_if<SideBySide>(&engines_)) {
      return beside->parameters()[at(engine)].geometry();
    }
  }
  return (*std::get_if<Alone>(&engines_))[at(engine)].geometry();
}

template <class S, int Engines, int Capacity, class List>
template <class F>
void Vehicle<S, Engines, Capacity, List>::with_engines(const F& f) {
  if constexpr (kMayRunSideBySide) {
    if (auto* beside = std::get_if<SideBySide>(&engines_)) {
      f.template operator()<typename SideBySide::Number>(beside->engines());
      return;
    }
  }
  f.template operator()<S>(*std::get_if<Alone>(&engines_));
}

template <class S, int Engines, int Capacity, class List>
Vehicle<S, Engines, Capacity, List>::Vehicle(const Parameters& parameters, double h, Stepping stepping)
    : h_(h), structure_(parameters.modes, h), engines_(form_of(parameters, h, stepping)) {
  for (std::size_t e = 0; e < Engines; ++e) {
    has_block_[e] = parameters.gimbals[e].has_block();
  }
  const auto& turned = structure_.rate_flexibility();
  const auto of_gimbals = [&](int first, int second) {
    return [&turned, first, second](std::size_t e) {
      const auto pitch = static_cast<int>(2 * e);
      return turned(pitch + first, kAxes + pitch + second);
    };
  };
  with_engines([&]<class T>(EnginesIn<T>& engines) {
    std::array<T, kSteps<T>> thrust{};
    for (std::size_t e = 0; e < engines.size(); ++e) {
      engines[e].set_rate_flexibility({over_engines<T>(e, of_gimbals(0, 0)), over_engines<T>(e, of_gimbals(1, 1)),
                                       over_engines<T>(e, of_gimbals(0, 1))});
      thrust[e] = engines[e].declared_thrust();
      stiffens_ = stiffens_ || engines[e].stiffens();
    }
    give_ = give_under<T>(engines, thrust);
  });
}

template <class S, int Engines, int Capacity, class List>
typename Vehicle<S, Engines, Capacity, List>::State Vehicle<S, Engines, Capacity, List>::steady(
    const std::array<S, kAxes>& commands, const std::array<S, Engines>& thrust) const {
  constexpr int kRounds = 60;  // each shrinks the change by K_n / (R^2 K_L), 1e-2, or the change of the arms, 1e-1
  return with_engines_alone([&](const Alone& engines) {
    const auto axis_model = [&](int i) -> const AxisModel& { return engines[at(i / 2)].axis(at(i % 2)); };
    State state;
    std::array<Coupling<S>, kAxes> around{};
    for (int i = 0; i < kAxes; ++i) {
      around[at(i)].arm = axis_model(i).parameters().actuator.moment_arm;
    }
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i < kAxes; ++i) {
        state.axes[at(i)] = axis_model(i).settled(commands[at(i)], around[at(i)]);
      }
      couple_at_rest(engines, state, around, thrust);
    }
    for (int i = 0; i < kAxes; ++i) {
      const auto& axis = axis_model(i);
      const S deflection = state.axes[at(i)].y(AxisModel::kPiston) -
                           axis.parameters().actuator.moment_arm * state.axes[at(i)].y(AxisModel::kAngle) -
                           around[at(i)].motion;
      state.softening[at(i)] = deflection - state.axes[at(i)].spring_force / axis.stiffness();
    }
    gather(state);
    return state;
  });
}

template <class S, int Engines, int Capacity, class List>
void Vehicle<S, Engines, Capacity, List>::couple_at_rest(const Alone& engines, State& state,
                                                         std::array<Coupling<S>, kAxes>& around,
                                                         const std::array<S, Engines>& thrust) const {
  typename Structure::PortVector forces = Structure::PortVector::Zero();
  const auto flexibility = structure_.static_flexibility();
  const auto turned = [&] { return typename Structure::PortVector(flexibility * state.structure.forces); }();
  for (int i = 0; i < kAxes; ++i) {
    forces(i) = state.axes[at(i)].spring_force;
    forces(kAxes + i) = engines[at(i / 2)].axis(at(i % 2)).parameters().engine.duct_stiffness *
                        (state.axes[at(i)].y(AxisModel::kAngle) - turned(kAxes + i));
  }
  state.structure = structure_.settled(forces);
  const typename Structure::PortVector moved = flexibility * forces;
  for (std::size_t e = 0; e < Engines; ++e) {
    engines[e].couple_at_rest(state_of(state, e), both_of<S>(forces, e), both_of<S>(moved, e), both_of<S>(moved, e, kAxes),
                              thrust[e], std::span<Coupling<S>, 2>(&around[2 * e], 2));
  }
}

template <class S, int Engines, int Capacity, class List>
template <class T>
typename Vehicle<S, Engines, Capacity, List>::Give Vehicle<S, Engines, Capacity, List>::give_under(
    const EnginesIn<T>& engines, const std::array<T, kSteps<T>>& thrust) const noexcept {
  std::array<S, kAxes> own;
  std::array<S, kAxes> cross;  // of an engine's two, the same
  std::array<S, kAxes> springs;
  for (std::size_t e = 0; e < engines.size(); ++e) {
    const auto flexibility = engines[e].flexibility(thrust[e]);
    put<T>(flexibility.own, e, own);
    put<T>({flexibility.cross, flexibility.cross}, e, cross);
    put<T>({T(1.0 / engines[e].axis(0).stiffness()), T(1.0 / engines[e].axis(1).stiffness())}, e, springs);
  }
  Give give;
  give.flexibility = structure_.mean_flexibility().template topLeftCorner<kAxes, kAxes>();
  for (int i = 0; i < kAxes; ++i) {
    give.flexibility(i, i) += own[at(i)];
    give.flexibility(i, i ^ 1) += cross[at(i)];
  }
  AxisMatrix with_springs = give.flexibility;
  for (int i = 0; i < kAxes; ++i) {
    with_springs(i, i) += springs[at(i)];
  }
  // Positive definite: the springs alone are, and what is added to them gives way.
  factorise<S, kAxes>(with_springs, give.factor);
  return give;
}

}  // namespace hotfire::model
