// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/explain/result/result.hpp"
#include "tools/explain/result/trace.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// What each equation leaves over, in words, and the points of the one in which the first effect found shows; of the loudest
/// where none was found. None without traces.
std::optional<TraceResult> trace_result(const std::vector<Trace>& traces, const std::vector<Kept>& kept);

/// Every candidate of every round, in order, with what it reached and why it was kept or dropped.
std::vector<SearchRow> search_rows(const std::vector<Trial>& trials);

}  // namespace hotfire::explain
