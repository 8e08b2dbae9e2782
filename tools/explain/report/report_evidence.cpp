// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/report_evidence.hpp"

#include <algorithm>

namespace hotfire::explain {

using nlohmann::json;

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

json trace_json(const std::vector<Trace>& traces, const std::vector<Kept>& kept) {
  if (traces.empty()) {
    return nullptr;
  }
  const auto own = std::find_if(traces.begin(), traces.end(), [&](const Trace& trace) {
    return !kept.empty() && trace.equation == equation_of(kept.front().trial.candidate.site);
  });
  const Trace& strongest = own == traces.end() ? traces.front() : *own;
  json points{{"x_label", strongest.depends_on.label},
              {"x_unit", strongest.depends_on.unit},
              {"y_label", strongest.missing.label},
              {"y_unit", strongest.missing.unit},
              {"x", json::array()},
              {"y", json::array()}};
  const std::size_t rows = strongest.depends_on.values.size();
  const std::size_t every = std::max<std::size_t>(1, rows / kTracePoints);
  for (std::size_t i = 0; i < rows; i += every) {
    points["x"].push_back(strongest.depends_on.values[i]);
    points["y"].push_back(strongest.missing.values[i]);
  }
  std::string text;
  for (const Trace& trace : traces) {
    if (!text.empty()) {
      text += ' ';
    }
    text += in_words(trace);
  }
  const std::string site = strongest.equation == "engine" ? "engine_torque"
                           : strongest.equation == "mass" ? "mass_force"
                                                          : "flow";
  return {{"site", site}, {"text", text}, {"points", points}};
}

json search_json(const std::vector<Trial>& trials) {
  json search = json::array();
  for (const Trial& trial : trials) {
    json row{{"round", trial.round},     {"candidate", trial.candidate.name}, {"delta_bic", trial.delta_criterion},
             {"seconds", trial.seconds}, {"decision", trial.decision},        {"reason", trial.reason}};
    if (!trial.candidate.option_name.empty()) {
      row["law"] = trial.candidate.option_name;
    }
    if (trial.refined) {
      row["held_out_rms_ratio"] = trial.held_out_ratio;
    }
    search.push_back(std::move(row));
  }
  return search;
}

}  // namespace hotfire::explain
