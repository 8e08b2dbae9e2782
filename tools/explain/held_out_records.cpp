// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/held_out_records.hpp"

#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

/// What a model found on other records predicts of `data`.
Prediction prediction_of(Fitted model, const Dataset& data, unsigned threads) {
  drop_parameters(model, [](const FreeParameter& parameter) { return parameter.is_initial_state(); });
  for (const FreeParameter& state : initial_states(data, scales_of(model.base, data), model.u)) {
    model.free.push_back(state);
  }
  Prediction prediction;
  if (!Evaluator(data, Resolution::fine).predict(model.base, model.free, model.u, threads, prediction)) {
    throw FileError(words::diverges_held_out(data.experiments.front().name));
  }
  return prediction;
}

}  // namespace

HeldOutRecord held_out_record(const Record& record, const Dataset& data, const StagePredictions& stages) {
  const auto& [declared, calibrated, explained] = stages;
  const Goodness of_declared = goodness(data, declared);
  const Goodness of_calibrated = goodness(data, calibrated);
  const Goodness of_explained = goodness(data, explained);
  HeldOutRecord result{record.path.string(), record.rows, record.period, {}};
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (data.used[c]) {
      result.channels.push_back({.name = data.channels[c],
                                 .unit = record.find(data.channels[c])->unit,
                                 .noise = data.noise[c],
                                 .noise_source = {},
                                 .declared = of_declared.fitted[c],
                                 .calibrated = of_calibrated.fitted[c],
                                 .explained = of_explained.fitted[c],
                                 .black_box = {}});
    }
  }
  return result;
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

std::vector<HeldOutRecord> held_out_records(const ExplainOptions& options, const std::vector<Dataset>& data,
                                            const SearchResult& found) {
  std::vector<HeldOutRecord> records;
  records.reserve(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto predicted = [&](const Assessed& stage) { return prediction_of(stage.model, data[i], options.threads); };
    records.push_back(held_out_record(options.kept_back[i], data[i],
                                      {predicted(found.declared), predicted(found.calibrated), predicted(found.explained)}));
  }
  return records;
}

}  // namespace hotfire::explain
