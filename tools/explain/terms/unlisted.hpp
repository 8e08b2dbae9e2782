// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/terms/candidates.hpp"
#include "tools/explain/terms/unlisted_words.hpp"

namespace hotfire::explain {

/// Every dependence of every unlisted term of `plant`, whatever its values, that the records can show.
std::vector<Candidate> unlisted_candidates(const ModelParameters& plant, const Dataset& data);

/// Activates an unlisted candidate in parameters that hold the effects of `current`, with its table as `lay_table` lays it.
void activate_unlisted(ModelParameters& parameters, const Candidate& candidate, const Dataset& data, const Fitted& current);

/// True if the candidate is an oscillator of the grammar: its curve is of a frequency.
bool is_oscillator(const Candidate& candidate);

/// True for a term that is a power of its argument.
bool is_power(const Candidate& candidate);

/// True for a curve in front of a memory whose output is zero at rest: a constant of the curve adds nothing.
bool forgets_constants(const Candidate& candidate);

/// True if the candidate's effect, of the list of `plant`, is a term of unknown law.
bool is_unlisted(const ModelParameters& plant, const Candidate& candidate);

/// The table that an unlisted effect of `parameters` uses; none where its law has no table.
std::optional<FittedTable> table_of(const ModelParameters& parameters, const Candidate& candidate);

/// True if a table over the rate of the motion that it is against pushes with that motion, or a level of damping is below
/// nothing, by more than a table's own scatter: friction and damping take energy out. Where a table over the rate is at
/// rate zero is a constant force.
bool feeds_energy(const ModelParameters& parameters, const Candidate& candidate);

}  // namespace hotfire::explain
