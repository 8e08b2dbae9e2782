// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/numerics/members.hpp"
#include "tools/linear/plant/plant.hpp"

namespace hotfire::linear {

/// Calls `f(value)` for every number of a state in the model's scalar, in the order of its members. Delay lines and memories
/// of a term, which hide theirs, are passed over.
template <class S, class T, class F>
void visit_scalars(T& value, F&& f);

namespace detail {

template <class T>
inline constexpr bool is_hidden = false;
template <class S, std::size_t N>
inline constexpr bool is_hidden<model::DelayLine<S, N>> = true;
template <class S>
inline constexpr bool is_hidden<model::MemoryState<S>> = true;

template <class T>
inline constexpr bool is_matrix = false;
template <class S, int Rows, int Columns>
inline constexpr bool is_matrix<Eigen::Matrix<S, Rows, Columns>> = true;

template <class T>
inline constexpr bool is_list = false;
template <class T, std::size_t N>
inline constexpr bool is_list<std::array<T, N>> = true;

template <class T>
inline constexpr bool is_tuple = false;
template <class... T>
inline constexpr bool is_tuple<std::tuple<T...>> = true;

}  // namespace detail

template <class S, class T, class F>
void visit_scalars(T& value, F&& f) {
  if constexpr (std::is_same_v<T, S>) {
    f(value);
  } else if constexpr (std::is_arithmetic_v<T> || detail::is_hidden<T>) {
    // No number of the model.
  } else if constexpr (detail::is_matrix<T>) {
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      f(value.data()[i]);
    }
  } else if constexpr (detail::is_list<T>) {
    for (auto& own : value) {
      visit_scalars<S>(own, f);
    }
  } else {
    auto members = [&] {
      if constexpr (detail::is_tuple<T>) {
        return std::apply([](auto&... own) { return std::tie(own...); }, value);
      } else {
        return model::tied(value);
      }
    }();
    std::apply([&](auto&... own) { (visit_scalars<S>(own, f), ...); }, members);
  }
}

/// True for a state of which something is hidden.
template <class T>
constexpr bool hides() {
  if constexpr (detail::is_hidden<T>) {
    return true;
  } else if constexpr (std::is_arithmetic_v<T> || detail::is_matrix<T> || std::is_empty_v<T> || requires(const T& x) {
                         x.a;
                         x.v;
                       }) {
    return false;
  } else if constexpr (detail::is_list<T>) {
    return hides<typename T::value_type>();
  } else {
    using Members = decltype(model::tied(std::declval<T&>()));
    return []<class... M>(std::type_identity<std::tuple<M...>>) {
      return (hides<std::remove_cvref_t<M>>() || ...);
    }(std::type_identity<Members>{});
  }
}

/// A number of a state in dual numbers, and what it is.
template <class S>
struct Labelled {
  S* value;
  Quantity quantity;
  bool continuous = false;
};

/// Every number of the states of a plant, with names for those that a reader of a linear model meets.
template <class S>
class Labels {
 public:
  template <class T>
  void add(T& value, const std::string& name, const std::string& unit, bool continuous = false) {
    std::vector<S*> found;
    visit_scalars<S>(value, [&](S& own) { found.push_back(&own); });
    for (std::size_t i = 0; i < found.size(); ++i) {
      all_.push_back({found[i], {found.size() == 1 ? name : name + "." + std::to_string(i + 1), unit}, continuous});
    }
  }

  /// Numbers with names of their own.
  template <class T, class Names>
  void add_each(T& value, const Names& names, const std::string& suffix, bool continuous = false) {
    std::size_t i = 0;
    visit_scalars<S>(value, [&](S& own) {
      all_.push_back({&own, {std::string(names[i][0]) + suffix, std::string(names[i][1])}, continuous});
      ++i;
    });
  }

  const std::vector<Labelled<S>>& all() const { return all_; }

  /// -1 if there is none of this name.
  int place_of(const std::string& name) const {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const auto& own) { return own.quantity.name == name; });
    return found == all_.end() ? -1 : static_cast<int>(found - all_.begin());
  }

 private:
  std::vector<Labelled<S>> all_{};
};

using NameAndUnit = std::array<std::string_view, 2>;

/// The continuous states of an axis in the order of `model::AxisStates`.
inline constexpr std::array<NameAndUnit, 8> kAxisStates{{{"spool", "1"},
                                                         {"spool_rate", "1/s"},
                                                         {"load_pressure", "Pa"},
                                                         {"washout", "Pa"},
                                                         {"piston", "m"},
                                                         {"piston_rate", "m/s"},
                                                         {"engine", "rad"},
                                                         {"engine_rate", "rad/s"}}};

/// The unit of what an effect remembers, as far as it is one for all of it.
constexpr std::string_view unit_of_memory(std::string_view effect) noexcept {
  constexpr std::array<NameAndUnit, 7> kUnits{{{"gimbal_friction", "rad"},
                                               {"gimbal_compliance", "N.m"},
                                               {"piston_friction", "m"},
                                               {"rate_limit", "rad"},
                                               {"valve_hysteresis", "1"},
                                               {"structural_mode", "kg^0.5.m"},
                                               {"backlash", "m"}}};
  for (const NameAndUnit& own : kUnits) {
    if (own[0] == effect) {
      return own[1];
    }
  }
  return "";
}

/// All numbers of an axis's state.
template <class S, class List, class AxisState>
void label_axis(AxisState& axis, const model::EffectParameters<S, List>& effects, const std::string& suffix,
                Labels<S>& labels) {
  labels.add_each(axis.y, kAxisStates, suffix, true);
  labels.add(axis.inputs, "iteration.inputs" + suffix, "");
  labels.add(axis.spring_force, "load_force" + suffix, "N");
  labels.add(axis.built_up, "iteration.built_up" + suffix, "m^3/s");
  labels.add(axis.effects.outputs, "iteration.effects" + suffix, "");
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (!is_port<E>) {
      if (effects.active[I]) {
        labels.add(std::get<I>(axis.effects.values), std::string(E::name) + suffix, std::string(unit_of_memory(E::name)));
      }
    }
  });
}

/// All numbers that the axes of a vehicle share.
template <class S, class State, class Parameters>
void label_vehicle(State& state, const Parameters& parameters, Labels<S>& labels) {
  for (int k = 0; k < parameters.modes.modes; ++k) {
    auto& mode = state.structure.modes[static_cast<std::size_t>(k)];
    const std::string name = "mode" + std::to_string(k + 1);
    labels.add(mode.displacement, name + ".displacement", "kg^0.5.m", true);
    labels.add(mode.velocity, name + ".rate", "kg^0.5.m/s", true);
  }
  labels.add(state.structure.displacement, "iteration.ports", "");
  labels.add(state.structure.residual, "structure.residual_rotation", "rad");
  labels.add(state.structure.forces, "iteration.forces", "");
  for (std::size_t e = 0; e < state.gimbals.size(); ++e) {
    auto& gimbal = state.gimbals[e];
    const std::string name = "bearing" + std::to_string(e + 1);
    constexpr std::array<NameAndUnit, 6> kDisplacement{
        {{".x", "m"}, {".y", "m"}, {".z", "m"}, {".roll", "rad"}, {".pitch", "rad"}, {".yaw", "rad"}}};
    for (int i = 0; i < 6; ++i) {
      const auto& own = kDisplacement[static_cast<std::size_t>(i)];
      labels.add(gimbal.bearing.displacement(i), name + std::string(own[0]), std::string(own[1]));
    }
    if (parameters.gimbals[e].has_block()) {
      auto& block = gimbal.bearing.block;
      for (std::size_t k = 0; k < block.modes.size(); ++k) {
        const std::string mode = name + ".block_mode" + std::to_string(k + 1);
        labels.add(block.modes[k].displacement, mode + ".displacement", "kg^0.5.m", true);
        labels.add(block.modes[k].velocity, mode + ".rate", "kg^0.5.m/s", true);
      }
      labels.add(block.displacement, "iteration.block" + std::to_string(e + 1), "");
      labels.add(block.forces, "iteration.wrench" + std::to_string(e + 1), "");
    }
    // Rigid friction has no bristle.
    const auto& friction = parameters.gimbals[e].friction;
    if (friction.rubs() && friction.law() != std::remove_cvref_t<decltype(friction)>::Law::coulomb) {
      labels.add(gimbal.bristle.pitch, name + ".bristle_pitch", "rad", true);
      labels.add(gimbal.bristle.yaw, name + ".bristle_yaw", "rad", true);
    }
    labels.add(gimbal.torque, "iteration.friction" + std::to_string(e + 1), "N.m");
  }
  labels.add(state.softening, "iteration.softening", "m");
}

}  // namespace hotfire::linear
