// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/explain/latent/locate.hpp"

namespace hotfire::explain {

/// `located` of docs/report.md: where what the explained model is still missing acts.
nlohmann::json located_json(const Dataset& data, const Located& located);

}  // namespace hotfire::explain
