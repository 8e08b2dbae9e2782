// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
/// clock. Throws FileError where a model runs away.
std::vector<HeldOutRecord> held_out_records(const ExplainOptions& options, const std::vector<Dataset>& data,
                                            const SearchResult& found);

/// What the declared, the calibrated and the explained model predict, in this order.
using StagePredictions = std::array<Prediction, 3>;

/// The same of one record and what the three models predict of it. `data` holds this record alone.
HeldOutRecord held_out_record(const Record& record, const Dataset& data, const StagePredictions& stages);

}  // namespace hotfire::explain
