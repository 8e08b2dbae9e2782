// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/explain/fit/evaluator.hpp"
#include "tools/explain/result/result.hpp"

namespace hotfire::explain {

/// The residual of the declared model before and of the explained model after, without a next experiment.
ResidualResult residual_result(const Dataset& data, const Prediction& before, const Prediction& after);

}  // namespace hotfire::explain
