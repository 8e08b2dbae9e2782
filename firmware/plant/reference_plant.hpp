// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/keys.hpp"
#include "model/simplex.hpp"

namespace hotfire::firmware {

/// The reference axis with every effect active at its typical value. A cycle of it costs most, so a timing check without a
/// model file runs it.
inline model::Simplex<double>::Parameters reference_plant_with_every_effect() {
  model::Simplex<double>::Parameters parameters;
  parameters.effects.active.fill(true);
  model::visit_effects(parameters, []<class E>(std::size_t, auto& values) {
    for (const auto& field : values.fields()) {
      values.*field.member = field.typical;
    }
    // A term of the grammar costs what it costs at any size, and its unit is that of its site and argument.
    if constexpr (requires { values.direct; }) {
      values.gain = values.direct = 0.0;
    }
  });
  return parameters;
}

}  // namespace hotfire::firmware
