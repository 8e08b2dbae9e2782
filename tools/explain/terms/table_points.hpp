// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// Calls `f.template operator()<E>(field, table)` with the table that an unlisted candidate's effect E uses in `parameters`;
/// not at all where its law has none.
template <IsModelParameters Parameters, class F>
void visit_table(Parameters& parameters, const Candidate& candidate, F&& f) {
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    using Values = std::remove_cvref_t<decltype(values)>;
    if constexpr (requires {
                    E::is_unlisted;
                    Values::tables();
                  }) {
      for (const auto& field : Values::tables()) {
        if (index == candidate.effect && model::is_used(field.options, candidate.option)) {
          f.template operator()<E>(field, values.*field.member);
        }
      }
    }
  });
}

/// Lays the points of an unlisted candidate's table over the range that `current` runs through on the rows that a fit sees:
/// evenly over a position, a pressure or time; closer about zero over a rate, where friction bends; over a sensor's own
/// reading where what `current` leaves there bends, since a sensor shows its error itself. All ordinates are zero.
void lay_table(ModelParameters& parameters, const Candidate& candidate, const Dataset& data, const Fitted& current);

/// `fitted` with the table of an unlisted candidate reaching over every row of `data`, which may go beyond those that it was
/// laid over: further points as far apart as they are at that end, as many as a table can hold, with the value at the end.
Fitted reaching_over(const Dataset& data, const Fitted& fitted, const Candidate& candidate);

}  // namespace hotfire::explain
