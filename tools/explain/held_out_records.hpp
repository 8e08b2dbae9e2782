// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/explain/explain.hpp"
#include "tools/explain/search/search.hpp"

namespace hotfire::explain {

/// The records of `options.kept_back`, a data set each, of which every row that is not excluded is judged. Throws as
/// `make_dataset`: before a search, so that none is in vain.
std::vector<Dataset> held_out_data(const ModelFile& model, const ExplainOptions& options);

/// How the declared, the calibrated and the explained model do on `options.kept_back`, which is in `data`: no fit and no
/// choice has seen a row of it. The explained model is the one of explained.toml, with what was found to be a fault of the
/// records. A force-driven mass starts as the first rows say, a sinusoid of unknown law at the phase of the record's own
/// clock. `held_out_records` of docs/report.md. Throws FileError where a model runs away.
template <class Family>
nlohmann::json held_out_records_json(const ExplainOptions& options, const std::vector<Dataset>& data,
                                     const SearchResult<Family>& found);

/// The same of one record and what three models predict of it, by name of the stage: "before", "calibrated", "after". `data`
/// holds this record alone.
nlohmann::json held_out_record_json(const Record& record, const Dataset& data,
                                    const std::vector<std::pair<const char*, Prediction>>& stages);

}  // namespace hotfire::explain
