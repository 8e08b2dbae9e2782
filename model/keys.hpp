// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// The place of a parameter in a configuration: `section.name`, or `effects.section.name` for an effect's.
struct Key {
  std::string_view section;
  bool is_effect;
  std::size_t effect_index;  ///< position in the effect list; 0 for a declared part

  bool operator==(const Key&) const = default;
};

template <class S, class... Es, class F>
constexpr void visit_effect_set(EffectParameters<S, EffectList<Es...>>& effects, F&& f) {
  EffectList<Es...>::for_each([&]<class E, std::size_t I>() { f.template operator()<E>(I, std::get<I>(effects.values)); });
}
template <class S, class... Es, class F>
constexpr void visit_effect_set(const EffectParameters<S, EffectList<Es...>>& effects, F&& f) {
  EffectList<Es...>::for_each([&]<class E, std::size_t I>() { f.template operator()<E>(I, std::get<I>(effects.values)); });
}

/// Calls `f.template operator()<E>(index, values)` for the parameters of every effect of a plant.
template <class Parameters, class F>
constexpr void visit_effects(Parameters& parameters, F&& f) {
  visit_effect_set(parameters.effects, f);
}

/// Calls `f(key, field, value)` for every scalar parameter of a plant: first the declared parts, then the effects, active or
/// not, in the order of the list. `value` is a reference into `parameters`; the order is the same for every scalar type.
template <class Parameters, class F>
void visit_parameters(Parameters& parameters, F&& f) {
  std::remove_const_t<Parameters>::for_each_part(parameters, [&](auto& part) {
    using Part = std::remove_cvref_t<decltype(part)>;
    for (const auto& field : Part::fields()) {
      f(Key{Part::name, false, 0}, field, part.*field.member);
    }
  });
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    for (const auto& field : std::remove_cvref_t<decltype(values)>::fields()) {
      f(Key{E::name, true, index}, field, values.*field.member);
    }
  });
}

/// Calls `f(value)` for every number of a plant that a fit may move: those of `visit_parameters` in its order, then the
/// ordinates of every effect's tables.
template <class Parameters, class F>
void visit_values(Parameters& parameters, F&& f) {
  visit_parameters(parameters, [&](const Key&, const auto&, auto& value) { f(value); });
  visit_effects(parameters, [&]<class E>(std::size_t, auto& values) {
    using Values = std::remove_cvref_t<decltype(values)>;
    if constexpr (requires { Values::tables(); }) {
      // Tables of one effect share their points, whatever they depend on.
      for (auto& y : (values.*Values::tables().front().member).y) {
        f(y);
      }
    }
  });
}

}  // namespace hotfire::model
