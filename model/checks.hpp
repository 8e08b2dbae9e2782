// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <type_traits>

#include "model/keys.hpp"

namespace hotfire::model {

// The check of what a key is given. Model files, plant images and the libraries read their keys in different ways and name
// different places in their messages; what they refuse is said here.

/// True if the value lies inside the bounds, which are allowed; false for NaN.
constexpr bool is_inside(double value, double lower, double upper) { return value >= lower && value <= upper; }

/// True if the value lies inside the field's bounds; false for NaN.
template <class Owner>
constexpr bool is_inside(const Field<Owner>& field, double value) {
  return is_inside(value, field.lower, field.upper);
}

/// The place of a word among the names of a law, a channel or another choice; -1 if it is none of them.
template <class Names>
constexpr int option_named(const Names& names, std::string_view word) {
  const auto found = std::find(names.begin(), names.end(), word);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// True if point i of a curve is finite and above the point before it.
template <class Points>
constexpr bool rises(const Points& x, std::size_t i) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  return is_inside(x[i], -kLargest, kLargest) && (i == 0 || x[i] > x[i - 1]);
}

/// An active effect, or a part, whose values contradict each other, and how; both empty if there is none.
struct Broken {
  std::string_view name;
  std::string_view relation;
};

/// The first active effect of a plant whose values contradict each other (`broken_relation` in declaration/effect.hpp), or
/// that acts where this plant has nothing (`missing_place` of its parameters).
template <class Parameters>
Broken broken_effect(const Parameters& plant) {
  Broken broken;
  visit_effects(plant, [&]<class E>(std::size_t index, const auto& values) {
    if (!broken.relation.empty() || !plant.effects.active[index]) {
      return;
    }
    if constexpr (requires { E::broken_relation(values); }) {
      broken = {E::name, E::broken_relation(values)};
    }
    if constexpr (requires { plant.missing_place(E::site); }) {
      if (broken.relation.empty()) {
        broken = {E::name, plant.missing_place(E::site)};
      }
    }
  });
  return broken;
}

/// The first declared part whose values contradict each other (`broken_relation` of the part).
template <class Parameters>
Broken broken_part(const Parameters& plant) {
  Broken broken;
  Parameters::for_each_part(plant, [&](const auto& part) {
    using Part = std::remove_cvref_t<decltype(part)>;
    if constexpr (requires { Part::broken_relation(part); }) {
      if (broken.relation.empty()) {
        broken = {Part::name, Part::broken_relation(part)};
      }
    }
  });
  return broken;
}

}  // namespace hotfire::model
