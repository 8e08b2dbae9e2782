// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/terms/assessed.hpp"

namespace hotfire::explain {

// A sinusoid of time that is in no list: its frequency is in the spectrum of what is left, its phase every record's own,
// until the records agree on one.

/// True if the candidate is a sinusoid of time.
bool is_periodic(const Candidate& candidate);

/// The clock of every record at its first row, as free parameters: the phase of a sinusoid.
std::vector<FreeParameter> clocks(const Dataset& data);

/// Starts for a sinusoid: at each of the frequencies, with the clock of every record at the best of six phases.
std::vector<std::vector<double>> periodic_starts(const Evaluator& evaluator, const Fitted& with_candidate,
                                                 std::size_t own_first, const std::vector<double>& frequencies);

/// `fitted` with one phase of its sinusoid at time zero of every record, the mean of theirs (over a circle, by rows), free
/// in place of the clocks: what a record that nobody has seen is predicted by.
Fitted with_common_phase(const Dataset& data, const Fitted& fitted, const Candidate& candidate);

}  // namespace hotfire::explain
