// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// Visits the parameters of the grammar's term that a candidate is; none if it is none.
template <class Parameters, class Visit>
void visit_term(Parameters& parameters, const Candidate& candidate, Visit&& visit) {
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (requires { E::is_term; }) {
      if (index == candidate.effect) {
        visit(values);
      }
    }
  });
}

}  // namespace hotfire::explain
