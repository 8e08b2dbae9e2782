// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "model/keys.hpp"
#include "tools/files/model/plant_of.hpp"

namespace hotfire::explain {

/// Parameters of whichever plant is explained: a hydraulic axis, a force-driven mass, a body on a given path or a structure
/// in modal coordinates. What lies above the simulation of a plant asks it for effects, fields and values by the functions
/// below, and is written and compiled once for all plants.
using ModelParameters = decltype(ModelFile::parameters);

template <class Parameters>
concept IsModelParameters = std::same_as<std::remove_const_t<Parameters>, ModelParameters>;

/// True for an axis that a servo moves to its command, false for all others.
inline bool is_hydraulic_axis(const ModelParameters& parameters) {
  return std::holds_alternative<SimplexParameters>(parameters);
}

inline bool is_active(const ModelParameters& parameters, std::size_t effect) {
  return std::visit([&](const auto& own) { return static_cast<bool>(own.effects.active[effect]); }, parameters);
}

inline void set_active(ModelParameters& parameters, std::size_t effect, bool active) {
  std::visit([&](auto& own) { own.effects.active[effect] = active; }, parameters);
}

/// `model::visit_effects`, `visit_parameters` and `visit_values` of whichever plant it is.
template <IsModelParameters Parameters, class F>
void visit_effects(Parameters& parameters, F&& f) {
  std::visit([&](auto& own) { model::visit_effects(own, f); }, parameters);
}
template <IsModelParameters Parameters, class F>
void visit_parameters(Parameters& parameters, F&& f) {
  std::visit([&](auto& own) { model::visit_parameters(own, f); }, parameters);
}
template <IsModelParameters Parameters, class F>
void visit_values(Parameters& parameters, F&& f) {
  std::visit([&](auto& own) { model::visit_values(own, f); }, parameters);
}

}  // namespace hotfire::explain
