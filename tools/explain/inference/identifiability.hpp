// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/fit/fit.hpp"

namespace hotfire::explain {

/// What the data do not separate, a sentence each:
/// - quantities of the plant that are identified although none of their factors is, such as K_T R^2 / J by a notch;
/// - groups of parameters that make up for each other, and at which rates (correlation beyond 0.95);
/// - declared parameters that the data say nothing on.
/// From J^T J and the priors at an optimum (`Fitted::normal`); tables and initial states are left out.
std::vector<std::string> not_separated(const Fitted& fitted);

}  // namespace hotfire::explain
