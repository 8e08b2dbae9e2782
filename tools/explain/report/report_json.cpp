// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/report_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/explain/data/statistics.hpp"
#include "tools/explain/inference/identifiability.hpp"
#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/report/curve.hpp"
#include "tools/explain/report/errors_json.hpp"
#include "tools/explain/report/located_json.hpp"
#include "tools/explain/report/report_evidence.hpp"
#include "tools/explain/report/report_residual.hpp"
#include "tools/explain/report/trace.hpp"
#include "tools/explain/report/verdict.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/words/warnings.hpp"

namespace hotfire::explain {

namespace {

using nlohmann::json;

json interval_of(const Estimate& estimate) {
  return estimate.interval ? json{estimate.interval->first, estimate.interval->second} : json(nullptr);
}

/// Where an interval comes from; null where there is none.
json source_of(const Estimate& estimate) {
  return !estimate.interval ? json(nullptr) : json(estimate.from_profile ? "profile" : "curvature");
}

bool noise_is_known(const Dataset& data) {
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (data.used[c] && !data.noise_is_known(c)) {
      return false;
    }
  }
  return true;
}

const char* source_of(NoiseSource source) {
  return source == NoiseSource::declared ? "declared" : source == NoiseSource::estimated ? "estimated" : "floor";
}

template <class Family>
std::vector<Estimate> estimates_of(const SearchResult<Family>& found) {
  const Fitted<Family>& model = found.explained.model;
  std::vector<Estimate> estimated = estimates(model.free, model.u, model.normal);
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    if (const auto profile = found.profiles.find(model.free[k].key); profile != found.profiles.end()) {
      estimated[k].interval = profile->second;
      estimated[k].from_profile = true;
    }
  }
  return estimated;
}

template <class Family>
json channels_json(const Dataset& data, const std::vector<Record>& records, const SearchResult<Family>& found) {
  json channels = json::object();
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!data.used[c]) {
      continue;
    }
    std::string unit;
    for (const Record& record : records) {
      if (const Channel* channel = record.find(data.channels[c])) {
        unit = channel->unit;
      }
    }
    channels[data.channels[c]] = {{"unit", unit},
                                  {"noise", data.noise[c]},
                                  {"noise_source", source_of(data.noise_source[c])},
                                  {"before", errors_of(found.declared.goodness.held_out[c])},
                                  {"calibrated", errors_of(found.calibrated.goodness.held_out[c])},
                                  {"after", errors_of(found.explained.goodness.held_out[c])}};
  }
  return channels;
}

/// Meaning of a field by the key that a free parameter carries.
template <class Family>
std::map<std::string, std::string> meanings() {
  std::map<std::string, std::string> result;
  const PlainParameters<Family> neutral;
  model::visit_parameters(neutral, [&](const model::Key& key, const auto& field, const double&) {
    result[(key.is_effect ? "effects." : "") + std::string(key.section) + "." + std::string(field.name)] = field.meaning;
  });
  return result;
}

/// A table's ordinate means what its table does; its place in it is the number that ends its key.
std::string meaning_of(const std::map<std::string, std::string>& meanings, const FreeParameter& free) {
  const auto known = meanings.find(free.key);
  return known != meanings.end() ? known->second : "point " + free.key.substr(free.key.rfind('.') + 1) + " of the table";
}

template <class Family>
json effects_json(const Dataset& data, const SearchResult<Family>& found, const std::vector<Estimate>& estimated) {
  json effects = json::array();
  const auto parameters =
      Evaluator<Family>::with_values(found.explained.model.base, found.explained.model.free, found.explained.model.u);
  const Reach reach = reach_of(data, parameters);
  const auto meaning = meanings<Family>();
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    const bool unlisted = is_unlisted<Family>(candidate);
    json effect{{"name", unlisted ? "unlisted" : candidate.name}, {"site", candidate.site}, {"parameters", json::object()}};
    if (unlisted) {
      effect["key"] = candidate.name;
      effect["sites"] = sites_of(kept);
    }
    if (!candidate.option_name.empty()) {
      effect["law"] = candidate.option_name;
    }
    const std::string prefix = "effects." + candidate.name + ".";
    for (std::size_t k = 0; k < estimated.size(); ++k) {
      const FreeParameter& free = found.explained.model.free[k];
      if (free.key.starts_with(prefix)) {
        effect["parameters"][free.key.substr(prefix.size())] = {{"value", estimated[k].value},
                                                                {"unit", free.unit},
                                                                {"ci95", interval_of(estimated[k])},
                                                                {"identified", estimated[k].interval.has_value()},
                                                                {"interval_from", source_of(estimated[k])},
                                                                {"meaning", meaning_of(meaning, free)}};
      }
    }
    effect["evidence"] = {{"held_out_error_drop_percent", 100.0 * (1.0 - kept.trial.held_out_ratio)},
                          {"delta_bic", kept.trial.delta_criterion}};
    effect["alternatives"] = json::array();
    for (const Trial& other : kept.alternatives) {
      if (other.refined && other.delta_criterion < 0.0) {
        json alternative{{"name", other.candidate.name},
                         {"delta_bic", other.delta_criterion - kept.trial.delta_criterion},
                         {"held_out_error_drop_percent", 100.0 * (1.0 - other.held_out_ratio)}};
        if (!other.candidate.option_name.empty()) {
          alternative["law"] = other.candidate.option_name;
        }
        effect["alternatives"].push_back(alternative);
      }
    }
    if (unlisted) {
      effect["is_not"] = what_it_is_not(found);
    }
    if (const auto table = unlisted ? table_of<Family>(parameters, candidate) : std::nullopt) {
      effect["looks_like"] = in_words(*table);
      effect["curve"] = {{"x_label", table->x_name},
                         {"x_unit", table->x_unit},
                         {"y_label", table->meaning},
                         {"y_unit", table->y_unit},
                         {"series", {{{"name", "as found"}, {"x", table->x}, {"y", table->y}}}}};
    } else if (unlisted) {
      effect["looks_like"] = law_in_words(candidate);
    } else {
      effect["curve"] = curve_of<Family>(parameters, candidate.effect, reach);
    }
    effects.push_back(std::move(effect));
  }
  return effects;
}

template <class Family>
json calibration_json(const SearchResult<Family>& found, const std::vector<Estimate>& estimated) {
  json calibration = json::object();
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const FreeParameter& free = found.explained.model.free[k];
    if (free.is_declared()) {
      calibration[free.key] = {
          {"declared", free.declared},   {"value", estimated[k].value}, {"ci95", interval_of(estimated[k])},
          {"tolerance", free.tolerance}, {"unit", free.unit},           {"pressed", estimated[k].pressed}};
    }
  }
  return calibration;
}

/// Effects that are no fault of the plant.
void warn_of_channels(const std::vector<Kept>& found, json& warnings) {
  for (const Kept& kept : found) {
    if (is_of_record_time(kept.trial.candidate)) {
      warnings.push_back(words::drifts(kept.trial.candidate.name, kept.trial.candidate.site));
    }
    const std::string& name = kept.trial.candidate.name;
    if (is_fault_of_record(kept.trial.candidate)) {
      const std::string& channel = kept.trial.candidate.option_name;
      warnings.push_back(words::fault_of_record(name, channel.empty() ? "command" : channel));
    }
  }
}

template <class Family>
json warnings_of(const ModelFile& model, const Dataset& data, const SearchResult<Family>& found,
                 const std::vector<Estimate>& estimated) {
  json warnings = json::array();
  if (found.interrupted) {
    warnings.push_back(words::ended_early());
  }
  warn_of_rows(data, warnings);
  warn_of_channels(found.kept, warnings);
  for (const std::string& key : model.left_out) {
    warnings.push_back(words::left_out(key));
  }
  if (found.explained.model.free.empty() || !found.explained.model.free.front().is_declared()) {
    warnings.push_back(words::no_tolerance());
  }
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const FreeParameter& free = found.explained.model.free[k];
    if (free.is_initial_state()) {
      continue;
    }
    if (estimated[k].pressed) {
      warnings.push_back(free.is_declared() ? words::moved_far(free.key, std::abs(found.explained.model.u[k]))
                                            : words::at_a_bound(free.key));
    } else if (!estimated[k].interval && !free.is_declared()) {
      warnings.push_back(words::undetermined(free.key));
    }
  }
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!data.used[c] || !data.noise_declared(c)) {
      continue;
    }
    std::vector<double> residual;
    for (std::size_t e = 0; e < data.experiments.size(); ++e) {
      const std::vector<double> part = scored_residual(data.experiments[e], found.explained.prediction[e], c);
      residual.insert(residual.end(), part.begin(), part.end());
    }
    const double seen = noise_from_differences(residual);
    if (seen > 1.5 * data.noise[c] || seen < data.noise[c] / 1.5) {
      warnings.push_back(words::noise_differs(data.channels[c], data.noise[c], seen));
    }
  }
  return warnings;
}

}  // namespace

json record_channels_json(const Dataset& data, std::size_t experiment, const Zeros& zeros) {
  const Experiment& record = data.experiments[experiment];
  json channels = json::object();
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!record.measured[c].empty()) {
      channels[data.channels[c]] = {{"noise", record.noise[c]}};
      if (record.zero_deviation[c] > 0.0) {
        channels[data.channels[c]]["zero"] = zeros[experiment][c];
      }
    }
  }
  return channels;
}

void warn_of_rows(const Dataset& data, json& warnings) {
  for (const Experiment& experiment : data.experiments) {
    for (const std::string& channel : experiment.unused) {
      warnings.push_back(words::unused_channel(experiment.name, channel, data.channels));
    }
  }
  for (const Experiment& experiment : data.experiments) {
    if (experiment.first_scored > 0) {
      warnings.push_back(
          words::not_at_rest(experiment.name, static_cast<double>(experiment.first_scored) * experiment.period));
    }
  }
  for (const Experiment& experiment : data.experiments) {
    for (const Block& block : experiment.excluded) {
      warnings.push_back(words::excluded(experiment.name, experiment.time_of(block.first), experiment.time_of(block.last)));
    }
    if (experiment.input_is_held) {
      warnings.push_back(words::input_held(experiment.name));
    }
  }
}

template <class Family>
json report_json(const ModelFile& model, const std::vector<Record>& records, const Dataset& data,
                 const SearchResult<Family>& found) {
  const std::vector<Estimate> estimated = estimates_of(found);
  const std::string verdict = verdict_of(data, found);
  const auto calibrated =
      Evaluator<Family>::with_values(found.calibrated.model.base, found.calibrated.model.free, found.calibrated.model.u);
  json report{{"schema", 1},
              {"model", model.path.string()},
              {"name", model.name},
              {"verdict", verdict},
              {"sentence", sentence_of(verdict, found, noise_is_known(data))},
              {"records", json::array()},
              {"held_out", held_out_names(data)},
              {"warnings", warnings_of(model, data, found, estimated)},
              {"channels", channels_json(data, records, found)},
              {"calibration", calibration_json(found, estimated)},
              {"effects", effects_json(data, found, estimated)},
              {"identifiability", json::array()},
              {"residual", residual_json(data, found.declared.prediction, found.explained.prediction)},
              {"search", search_json(found.trials)}};
  if (!found.located.places.empty()) {
    report["located"] = located_json(data, found.located);
  }
  for (const std::string& sentence : not_told_apart(found.explained.model)) {
    report["identifiability"].push_back({{"text", sentence}});
  }
  for (std::size_t e = 0; e < records.size(); ++e) {
    report["records"].push_back({{"path", records[e].path.string()},
                                 {"rows", records[e].rows},
                                 {"period", records[e].period},
                                 {"channels", record_channels_json(data, e, found.explained.zeros)}});
  }
  // What the calibrated model lacks: against the declared one a wrong value would show as well.
  if (const json trace = trace_json(reconstruct(without_zeros(data, found.calibrated.zeros), calibrated), found.kept);
      !trace.is_null()) {
    report["trace"] = trace;
  }
  return report;
}

template json report_json(const ModelFile&, const std::vector<Record>&, const Dataset&, const SearchResult<SimplexFamily>&);
template json report_json(const ModelFile&, const std::vector<Record>&, const Dataset&, const SearchResult<DirectFamily>&);

}  // namespace hotfire::explain
