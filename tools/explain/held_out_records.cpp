// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/held_out_records.hpp"

#include <utility>

#include "tools/explain/report/errors_json.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

/// What a model found on other records predicts of `data`.
template <class Family>
Prediction prediction_of(Fitted<Family> model, const Dataset& data, unsigned threads) {
  drop_parameters(model, [](const FreeParameter& parameter) { return parameter.is_initial_state(); });
  Scales scales;
  if constexpr (std::is_same_v<Family, DirectFamily>) {
    scales = scales_of(data);
  }
  for (const FreeParameter& state : initial_states(data, scales, model.u)) {
    model.free.push_back(state);
  }
  Prediction prediction;
  if (!Evaluator<Family>(data, Resolution::fine).predict(model.base, model.free, model.u, threads, prediction)) {
    throw FileError(words::diverges_held_out(data.experiments.front().name));
  }
  return prediction;
}

}  // namespace

nlohmann::json held_out_record_json(const Record& record, const Dataset& data,
                                    const std::vector<std::pair<const char*, Prediction>>& stages) {
  nlohmann::json channels = nlohmann::json::object();
  for (const auto& [stage, prediction] : stages) {
    const Goodness reached = goodness(data, prediction);
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      if (data.used[c]) {
        channels[data.channels[c]]["unit"] = record.find(data.channels[c])->unit;
        channels[data.channels[c]]["noise"] = data.noise[c];
        channels[data.channels[c]][stage] = errors_of(reached.fitted[c]);
      }
    }
  }
  return {{"path", record.path.string()}, {"rows", record.rows}, {"period", record.period}, {"channels", channels}};
}

std::vector<Dataset> held_out_data(const ModelFile& model, const ExplainOptions& options) {
  std::vector<Dataset> data;
  data.reserve(options.kept_back.size());
  for (const Record& record : options.kept_back) {
    data.push_back(make_dataset(model, {record}, options.exclusions));
    fit_every_row(data.back());
  }
  return data;
}

template <class Family>
nlohmann::json held_out_records_json(const ExplainOptions& options, const std::vector<Dataset>& data,
                                     const SearchResult<Family>& found) {
  nlohmann::json records = nlohmann::json::array();
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto predicted = [&](const Assessed<Family>& stage) {
      return prediction_of(stage.model, data[i], options.threads);
    };
    records.push_back(held_out_record_json(options.kept_back[i], data[i],
                                           {{"before", predicted(found.declared)},
                                            {"calibrated", predicted(found.calibrated)},
                                            {"after", predicted(found.explained)}}));
  }
  return records;
}

template nlohmann::json held_out_records_json(const ExplainOptions&, const std::vector<Dataset>&,
                                              const SearchResult<SimplexFamily>&);
template nlohmann::json held_out_records_json(const ExplainOptions&, const std::vector<Dataset>&,
                                              const SearchResult<DirectFamily>&);

}  // namespace hotfire::explain
