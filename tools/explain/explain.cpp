// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/explain.hpp"

#include <algorithm>
#include <functional>

#include "tools/explain/baseline.hpp"
#include "tools/explain/held_out_records.hpp"
#include "tools/explain/inference/common_bias.hpp"
#include "tools/explain/result/conclusion.hpp"
#include "tools/explain/result/result_of.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/explain/words/warnings.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

/// Says which test would separate two effects, and leaves its command in the explanation.
void add_next_experiment(const Dataset& data, const Rival& rival, const Fitted& explained, const ExplainOptions& options,
                         Explanation& explanation) {
  std::string text = words::explain_equally(label(rival.kept), label(rival.other));
  if (is_hydraulic_axis(explained.base)) {
    options.watch.progress(
        {Work::concluding, "searching for the experiment that separates them", SharesOfWork::kFittedToAllRows});
    const std::string limits = options.limits ? words::limits_of_rig() : words::limits_of_records();
    NextExperiment next =
        best_separation(data, explained, rival.model, options.limits.value_or(limits_of(data)), options.threads);
    // Over some thousand rows a mean square of a hundredth of the noise's is beyond chance.
    constexpr double kSeparates = 0.1;
    if (next.words.empty()) {
      text += " " + words::no_profile(limits);
    } else if (next.separation > kSeparates) {
      text += " " + words::separating_profile(next.words, next.separation, limits);
      explanation.next_experiment = std::move(next);
    } else {
      text += " " + words::weak_profile(next.words, next.separation, limits);
    }
  }
  explanation.result.residual.next_experiment = text;
}

/// Refuses records in which a mass moves against its force. A servo is held to its declared model before the search
/// (`refuse_impossible_channels`); a mass may rightly be anywhere without its missing effects, so it is the end of a search
/// that decides: nothing follows the mass, and with the force turned something does.
void refuse_turned_sign(const Dataset& data, const ModelFile& model, const SearchOptions& options,
                        const SearchResult& found) {
  constexpr double kFollowsMass = 50.0;  // percent of the motion
  constexpr double kClearlyLess = 0.5;
  const std::vector<ChannelFit>& fits = found.explained.goodness.held_out;
  const auto first = static_cast<std::size_t>(std::ranges::find(data.used, true) - data.used.begin());
  bool follows = false;
  for (std::size_t c = 0; c < fits.size(); ++c) {
    follows = follows || (data.used[c] && fits[c].fit_percent >= kFollowsMass);
  }
  if (!found.searched || found.interrupted || follows) {
    return;
  }
  const ChannelFit& left = fits[first];
  options.watch.progress({Work::concluding, "nothing follows the mass: the same with its force turned"});
  Dataset turned = data;
  for (Experiment& experiment : turned.experiments) {
    std::ranges::transform(experiment.input, experiment.input.begin(), std::negate<>());
  }
  const SearchResult other = search(turned, model, options);
  const double left_turned = other.explained.goodness.held_out[first].rms;
  if (!other.interrupted && left_turned < kClearlyLess * left.rms) {
    throw FileError(words::turned_mass(data.experiments.front().name, left_turned, left.rms));
  }
}

/// Zeros that are those of one null bias of the valve: the plant has it.
void add_common_bias(const Dataset& data, const SearchResult& found, Explanation& explanation) {
  auto& plant = std::get<SimplexParameters>(explanation.model.parameters);
  if (const auto bias = common_valve_bias(data, found.explained.zeros, plant)) {
    plant = with_valve_bias(plant, *bias);
    explanation.result.valve_bias = *bias;
    explanation.result.warnings.push_back(words::common_bias(*bias));
  }
}

}  // namespace

Explanation explain(const ModelFile& model, const std::vector<Record>& records, const ExplainOptions& options) {
  Dataset data = make_dataset(model, records, options.exclusions);
  const std::vector<Dataset> kept_back = held_out_data(model, options);
  const SearchOptions search_options{options.threads, options.most_effects, options.watch};
  SearchResult found = search(data, model, search_options);
  const bool is_axis = is_hydraulic_axis(model.parameters);
  if (!is_axis) {
    refuse_turned_sign(data, model, search_options, found);
  }
  options.watch.progress({Work::concluding, "fitting a linear black box, to compare"});
  const BlackBox box = black_box(data, options.threads);
  if (!found.interrupted) {
    options.watch.progress({Work::concluding, "fitting what was found to all rows", SharesOfWork::kComparedWithBlackBox});
    fit_to_all_rows(data, options.threads, found);
  }
  Explanation explanation{result_of(model, records, data, found), series_of(records, data, found), model, {}};
  Result& result = explanation.result;
  result.baseline = baseline_of(box, data, found.explained.prediction);
  if (result.baseline && result.baseline->is_better) {
    result.sentence += " " + words::black_box_is_better();
  }
  result.held_out_records = held_out_records(options, kept_back, found);
  for (std::size_t i = 0; i < kept_back.size(); ++i) {
    add_baseline(box, kept_back[i], result.held_out_records[i].channels);
    warn_of_rows(kept_back[i], result.warnings);
  }
  if (found.rival) {
    add_next_experiment(data, *found.rival, found.explained.model, options, explanation);
  }
  explanation.model.parameters = plant_of(found, options.keep_drift);
  if (is_axis) {
    add_common_bias(data, found, explanation);
  }
  return explanation;
}

}  // namespace hotfire::explain
