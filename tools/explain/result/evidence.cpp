// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/evidence.hpp"

#include <algorithm>

namespace hotfire::explain {

namespace {

/// Points of a trace that the page draws: more hide each other.
constexpr std::size_t kTracePoints = 3000;

/// Equation in which an effect of a site shows.
std::string equation_of(const std::string& site) {
  if (site == "mass_force") {
    return "mass";
  }
  return site == "engine_torque" || site == "load_spring" || site == "structure" ? "engine" : "flow";
}

}  // namespace

std::optional<TraceResult> trace_result(const std::vector<Trace>& traces, const std::vector<Kept>& kept) {
  if (traces.empty()) {
    return std::nullopt;
  }
  const auto own = std::find_if(traces.begin(), traces.end(), [&](const Trace& trace) {
    return !kept.empty() && trace.equation == equation_of(kept.front().trial.candidate.site);
  });
  const Trace& strongest = own == traces.end() ? traces.front() : *own;
  TraceResult result;
  result.site = strongest.equation == "engine" ? "engine_torque" : strongest.equation == "mass" ? "mass_force" : "flow";
  for (const Trace& trace : traces) {
    result.text += (result.text.empty() ? "" : " ") + in_words(trace);
  }
  result.axes = {strongest.depends_on.label, strongest.depends_on.unit, strongest.missing.label, strongest.missing.unit};
  const std::size_t rows = strongest.depends_on.values.size();
  const std::size_t every = std::max<std::size_t>(1, rows / kTracePoints);
  for (std::size_t i = 0; i < rows; i += every) {
    result.x.push_back(strongest.depends_on.values[i]);
    result.y.push_back(strongest.missing.values[i]);
  }
  return result;
}

std::vector<SearchRow> search_rows(const std::vector<Trial>& trials) {
  std::vector<SearchRow> rows;
  rows.reserve(trials.size());
  for (const Trial& trial : trials) {
    rows.push_back({.axis = {},
                    .round = trial.round,
                    .candidate = trial.candidate.name,
                    .law = trial.candidate.option_name,
                    .delta_criterion = trial.delta_criterion,
                    .held_out_ratio = trial.refined ? std::optional(trial.held_out_ratio) : std::nullopt,
                    .seconds = trial.seconds,
                    .decision = trial.decision,
                    .reason = trial.reason});
  }
  return rows;
}

}  // namespace hotfire::explain
