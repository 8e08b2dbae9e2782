// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/result_of.hpp"

#include <algorithm>
#include <cmath>

#include "tools/explain/data/statistics.hpp"
#include "tools/explain/inference/identifiability.hpp"
#include "tools/explain/result/evidence.hpp"
#include "tools/explain/result/found_effects.hpp"
#include "tools/explain/result/residual.hpp"
#include "tools/explain/result/trace.hpp"
#include "tools/explain/result/verdict.hpp"
#include "tools/explain/words/warnings.hpp"

namespace hotfire::explain {

namespace {

bool noise_is_known(const Dataset& data) {
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (data.used[c] && !data.noise_is_known(c)) {
      return false;
    }
  }
  return true;
}

std::vector<ChannelErrors> channel_errors(const Dataset& data, const std::vector<Record>& records,
                                          const SearchResult& found) {
  std::vector<ChannelErrors> channels;
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
    channels.push_back({.name = data.channels[c],
                        .unit = unit,
                        .noise = data.noise[c],
                        .noise_source = data.noise_source[c],
                        .declared = found.declared.goodness.held_out[c],
                        .calibrated = found.calibrated.goodness.held_out[c],
                        .explained = found.explained.goodness.held_out[c],
                        .black_box = {}});
  }
  return channels;
}

std::vector<CalibratedParameter> calibration_of(const SearchResult& found, const std::vector<Estimate>& estimated) {
  std::vector<CalibratedParameter> calibration;
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const FreeParameter& free = found.explained.model.free[k];
    if (free.is_declared()) {
      calibration.push_back({free.key, free.unit, free.declared, estimated[k].value, estimated[k].interval, free.tolerance,
                             estimated[k].pressed});
    }
  }
  return calibration;
}

/// Effects that are no fault of the plant.
void warn_of_channels(const ModelParameters& plant, const std::vector<Kept>& found, std::vector<std::string>& warnings) {
  for (const Kept& kept : found) {
    if (is_of_record_time(kept.trial.candidate)) {
      warnings.push_back(words::drifts(kept.trial.candidate.name, kept.trial.candidate.site,
                                       has_mean_over_time(plant, kept.trial.candidate)));
    }
    const std::string& name = kept.trial.candidate.name;
    if (is_fault_of_record(kept.trial.candidate)) {
      const std::string& channel = kept.trial.candidate.option_name;
      warnings.push_back(words::fault_of_record(name, channel.empty() ? "command" : channel));
    }
  }
}

std::vector<std::string> warnings_of(const ModelFile& model, const Dataset& data, const SearchResult& found,
                                     const std::vector<Estimate>& estimated) {
  std::vector<std::string> warnings;
  if (found.interrupted) {
    warnings.push_back(words::ended_early());
  }
  warn_of_rows(data, warnings);
  warn_of_channels(found.explained.model.base, found.kept, warnings);
  for (const Candidate& effect : found.not_supported) {
    warnings.push_back(words::not_supported(label(effect)));
  }
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

std::vector<RecordResult> record_results(const std::vector<Record>& records, const Dataset& data, const Zeros& zeros) {
  std::vector<RecordResult> results;
  for (std::size_t e = 0; e < records.size(); ++e) {
    const Experiment& experiment = data.experiments[e];
    RecordResult& result = results.emplace_back();
    result.path = records[e].path.string();
    result.rows = records[e].rows;
    result.period = records[e].period;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (!experiment.measured[c].empty()) {
        const bool zero_is_free = experiment.zero_deviation[c] > 0.0;
        result.channels.push_back(
            {data.channels[c], experiment.noise[c], zero_is_free ? std::optional(zeros[e][c]) : std::nullopt});
      }
    }
  }
  return results;
}

std::optional<LocatedResult> located_result(const Dataset& data, const Located& located) {
  if (located.places.empty()) {
    return std::nullopt;
  }
  LocatedResult result{located.likely_sites(), located.is_single, {}};
  for (const Place& place : located.places) {
    LocatedPlace& own = result.places.emplace_back();
    own.sites = place.sites;
    own.log_likelihood_gain = place.gain;
    own.is_likely = place.is_likely;
    for (std::size_t c = 0; c < place.leaves.size(); ++c) {
      if (data.used[c]) {
        own.mean_square_over_noise.emplace_back(data.channels[c], place.leaves[c]);
      }
    }
  }
  return result;
}

}  // namespace

void warn_of_rows(const Dataset& data, std::vector<std::string>& warnings) {
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

Result result_of(const ModelFile& model, const std::vector<Record>& records, const Dataset& data,
                 const SearchResult& found) {
  const std::vector<Estimate> estimated = estimates_of(found);
  Result result;
  result.model = model.path.string();
  result.name = model.name;
  result.verdict = verdict_of(data, found);
  result.sentence = sentence_of(result.verdict, found, noise_is_known(data));
  result.records = record_results(records, data, found.explained.zeros);
  result.held_out = held_out_names(data);
  result.warnings = warnings_of(model, data, found, estimated);
  result.channels = channel_errors(data, records, found);
  result.calibration = calibration_of(found, estimated);
  result.effects = found_effects(data, found, estimated);
  result.identifiability = not_separated(found.explained.model);
  result.residual = residual_result(data, found.declared.prediction, found.explained.prediction);
  result.search = search_rows(found.trials);
  result.located = located_result(data, found.located);
  // Of the calibrated model: beside the declared one a wrong value of a parameter would show as well.
  const auto calibrated = found.calibrated.model.parameters();
  result.trace = trace_result(reconstruct(without_zeros(data, found.calibrated.zeros), calibrated), found.kept);
  return result;
}

}  // namespace hotfire::explain
