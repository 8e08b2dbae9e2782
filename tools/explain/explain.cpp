#include "tools/explain/explain.hpp"

#include <fmt/format.h>

#include "tools/explain/conclusion.hpp"
#include "tools/explain/held_out_records.hpp"
#include "tools/explain/report_json.hpp"
#include "tools/explain/search.hpp"

namespace hotfire::explain {

namespace {

/// Says which test would tell two effects apart, and leaves its command in the explanation.
template <class Family>
void add_next_experiment(const Dataset& data, const Rival<Family>& rival, const Fitted<Family>& explained,
                         const ExplainOptions& options, Explanation& explanation) {
  std::string text = fmt::format("{} and {} explain these records equally well", label(rival.kept), label(rival.other));
  if constexpr (std::is_same_v<Family, SimplexFamily>) {
    options.watch.progress("looking for the experiment that tells them apart");
    const char* limits = options.limits ? "the rig's limits" : "these records' largest command";
    NextExperiment next =
        best_separation(data, explained, rival.model, options.limits.value_or(limits_of(data)), options.threads);
    // Over some thousand rows a mean square of a hundredth of the noise's is beyond chance.
    constexpr double kTells = 0.1;
    if (next.words.empty()) {
      text += fmt::format(", and {} leave no profile to tell them apart", limits);
    } else if (next.separation > kTells) {
      text += fmt::format(
          ": under {} they differ by {:.2g} times the sensor noise (rms), more than under any other profile tried within {}",
          next.words, next.separation, limits);
      explanation.next_experiment = std::move(next);
    } else {
      text += fmt::format(", and no profile within {} tells them apart: the best, {}, shows {:.2g} of the sensor noise",
                          limits, next.words, next.separation);
    }
  }
  explanation.report["residual"]["next_experiment"] = text + ".";
}

template <class Family>
Explanation explain_as(const ModelFile& model, const std::vector<Record>& records, const ExplainOptions& options) {
  const Dataset data = make_dataset(model, records, options.exclusions);
  const std::vector<Dataset> kept_back = held_out_data(model, options);
  SearchResult<Family> found = search<Family>(data, model, {options.threads, options.most_effects, options.watch});
  if (!found.interrupted) {
    options.watch.progress("fitting what was found to all rows");
    fit_to_all_rows(data, options.threads, found);
  }
  Explanation explanation{report_json(model, records, data, found), series_of(records, data, found), model, {}};
  if (!kept_back.empty()) {
    explanation.report["held_out_records"] = held_out_records_json(options, kept_back, found);
    for (const Dataset& record : kept_back) {
      warn_of_rows(record, explanation.report["warnings"]);
    }
  }
  if (found.rival) {
    add_next_experiment(data, *found.rival, found.explained.model, options, explanation);
  }
  explanation.model.parameters = plant_of(found);
  return explanation;
}

}  // namespace

Explanation explain(const ModelFile& model, const std::vector<Record>& records, const ExplainOptions& options) {
  return std::holds_alternative<SimplexParameters>(model.parameters) ? explain_as<SimplexFamily>(model, records, options)
                                                                     : explain_as<DirectFamily>(model, records, options);
}

}  // namespace hotfire::explain
