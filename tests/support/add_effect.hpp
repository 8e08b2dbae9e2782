// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>

#include "model/keys.hpp"

namespace hotfire::test {

/// Makes the effect or term `E` of a plant active; `set(values)` sets its parameters. Returns its place in the list.
template <class E, class Parameters, class Set>
std::size_t add_effect(Parameters& parameters, Set&& set) {
  std::size_t place = 0;
  model::visit_effects(parameters, [&]<class Own>(std::size_t index, auto& values) {
    if constexpr (std::is_same_v<Own, E>) {
      place = index;
      parameters.effects.active[index] = true;
      set(values);
    }
  });
  return place;
}

}  // namespace hotfire::test
