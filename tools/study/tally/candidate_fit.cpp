// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/candidate_fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/explain/refine/watch.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/files/text/error.hpp"
#include "tools/study/tally/judge.hpp"

namespace hotfire::study {

namespace {

explain::Candidate candidate_named(const ModelFile& model, const explain::Dataset& data, const std::string& name,
                                   const std::string& law) {
  const std::vector<explain::Candidate> all = explain::all_candidates(model.parameters, data);
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name && c.option_name == law; });
  if (found != all.end()) {
    return *found;
  }
  std::string known;
  for (const explain::Candidate& candidate : all) {
    known += (known.empty() ? "" : ", ") + explain::label(candidate);
  }
  throw UsageError(fmt::format("no candidate is called {} (law \"{}\"); there are {}", name, law, known));
}

}  // namespace

CandidateFit fit_candidate(const std::filesystem::path& folder, const std::string& name, const std::string& law,
                           unsigned threads) {
  ModelFile model = load_model(folder / "given/declared.toml");
  if (!std::holds_alternative<SimplexParameters>(model.parameters)) {
    throw FileError(fmt::format("{}: topology is not simplex; give a case of one axis", model.path.string()));
  }
  explain::Dataset data = explain::make_dataset(model, given_records(folder / "given"));
  explain::fit_every_row(data);
  const explain::Candidate candidate = candidate_named(model, data, name, law);

  const explain::Stopwatch stopwatch;
  explain::Fitted start;
  start.base = model.parameters;
  explain::activate(start.base, candidate);
  start.free = explain::declared_parameters(start.base, model.tolerance);
  start.u.assign(start.free.size(), 0.0);
  for (const explain::FreeParameter& own : explain::effect_parameters(start.base, candidate, {})) {
    start.free.push_back(own);
    start.u.push_back(own.coordinate(own.unit_size));
  }
  // As the search does: first with half as many steps.
  const explain::Evaluator coarse(data, explain::Resolution::coarse);
  const explain::Evaluator fine(data, explain::Resolution::fine);
  const explain::Assessed ranked = explain::refined(coarse, fine, threads, start, explain::kRanking);
  const explain::Assessed fitted =
      ranked.good() ? explain::refined(fine, fine, threads, ranked.model, explain::kFinal) : ranked;
  if (!fitted.good()) {
    throw FileError(fmt::format("{}: the model with {} can't be simulated", folder.string(), explain::label(candidate)));
  }
  CandidateFit result;
  result.seconds = stopwatch.seconds();
  result.processor_seconds = stopwatch.processor_seconds();
  result.name = folder.filename().string();
  result.candidate = explain::label(candidate);
  model.parameters = fitted.model.parameters();
  result.after = errors_of(model, load_record(folder / "kept/score_noisefree.csv"), model.noise);
  return result;
}

nlohmann::json json_of(const CandidateFit& fit) {
  return {{"case", fit.name},
          {"candidate", fit.candidate},
          {"seconds", fit.seconds},
          {"processor_seconds", fit.processor_seconds},
          {"after", fit.after}};
}

}  // namespace hotfire::study
