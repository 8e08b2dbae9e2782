// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/explain/fit/evaluator.hpp"

namespace hotfire::explain {

/// What is left, for report.json (docs/report.md): of the declared model before and of the explained one after.
nlohmann::json residual_json(const Dataset& data, const Prediction& before, const Prediction& after);

}  // namespace hotfire::explain
