// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"
#include "tools/explain/terms/unlisted_words.hpp"

namespace hotfire::explain {

/// Every dependence of every unlisted term of the family that the records can show.
template <class Family>
std::vector<Candidate> unlisted_candidates(const Dataset& data);

/// Activates an unlisted candidate in parameters that hold the effects of `current`, with its table as `lay_table` lays it.
template <class Family>
void activate_unlisted(PlainParameters<Family>& parameters, const Candidate& candidate, const Dataset& data,
                       const Fitted<Family>& current);

/// True if the candidate's effect is a term of unknown law.
template <class Family>
bool is_unlisted(const Candidate& candidate);

/// The table that an unlisted effect of `parameters` uses; none where its law has no table.
template <class Family>
std::optional<FittedTable> table_of(const PlainParameters<Family>& parameters, const Candidate& candidate);

/// True if a table over the rate of the motion that it is against pushes with that motion, or a level of damping is below
/// nothing, by more than a table's own scatter: friction and damping take energy out. Where a table over the rate is at
/// rate zero is a constant force.
template <class Family>
bool feeds_energy(const PlainParameters<Family>& parameters, const Candidate& candidate);

}  // namespace hotfire::explain
