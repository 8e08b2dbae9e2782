// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "model/actuator/axis.hpp"
#include "model/effects.hpp"
#include "tools/files/model/model_file.hpp"

namespace hotfire::explain {

namespace detail {

/// Calls `f(from, to)` with the places in two lists of effects of every effect that both have.
template <class From, class To, class F>
void for_common_effects(F&& f) {
  From::for_each([&]<class E, std::size_t I>() {
    To::for_each([&]<class Other, std::size_t K>() {
      if constexpr (std::is_same_v<E, Other>) {
        f(std::integral_constant<std::size_t, I>{}, std::integral_constant<std::size_t, K>{});
      }
    });
  });
}

template <class From, class To>
void copy_parameters(const typename model::Axis<double, From>::Parameters& from,
                     typename model::Axis<double, To>::Parameters& to) {
  to.servovalve = from.servovalve;
  to.actuator = from.actuator;
  to.structure = from.structure;
  to.engine = from.engine;
  for_common_effects<From, To>([&](auto i, auto k) {
    std::get<k>(to.effects.values) = std::get<i>(from.effects.values);
    to.effects.active[k] = from.effects.active[i];
  });
}

}  // namespace detail

/// An axis of a vehicle as a model of one axis, and back. Every effect of the vehicle's list is one of a single axis; back,
/// effects that the vehicle does not know are left out.
template <class List>
SimplexParameters alone(const typename model::Axis<double, List>::Parameters& axis) {
  SimplexParameters parameters;
  detail::copy_parameters<List, model::SimplexEffects>(axis, parameters);
  return parameters;
}
template <class List>
void put_back(const SimplexParameters& parameters, typename model::Axis<double, List>::Parameters& axis) {
  detail::copy_parameters<model::SimplexEffects, List>(parameters, axis);
}

/// The names of the effects of a list, if they are not all that a single axis knows; then nothing.
template <class List>
std::vector<std::string> known_effects() {
  std::vector<std::string> names;
  if constexpr (!std::is_same_v<List, model::SimplexEffects>) {
    List::for_each([&]<class E, std::size_t>() { names.emplace_back(E::name); });
  }
  return names;
}

}  // namespace hotfire::explain
