// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>

#include "tools/explain/fit/fit.hpp"

namespace hotfire::explain {

/// 95 % intervals [from, to] of parameters.
using Intervals = std::map<Address, std::pair<double, double>>;

/// Intervals of those parameters of effects whose error does not rise as its curvature at the optimum says: there, an
/// interval ends where the tempered sum of squares, all other parameters fitted again, is 3.84 above the optimum (profile
/// likelihood, chi-squared of one degree of freedom [Venzon and Moolgavkar 1988, Applied Statistics 37(1)]). `fitted` is to
/// be an optimum on the rows of `evaluator`. Left out: the others, tables, what the data do not determine, and chaotic
/// models, whose error has no profile.
Intervals profile_intervals(const Evaluator& evaluator, const Fitted& fitted, unsigned threads);

}  // namespace hotfire::explain
