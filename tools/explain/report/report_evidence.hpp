// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/explain/report/trace.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// What each equation leaves over, in words, and the points of the one in which the first effect found shows; of the loudest
/// where none was found. Null without traces.
nlohmann::json trace_json(const std::vector<Trace>& traces, const std::vector<Kept>& kept);

/// Every candidate of every round, in order, with what it reached and why it was kept or dropped.
nlohmann::json search_json(const std::vector<Trial>& trials);

}  // namespace hotfire::explain
