#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/explain/search.hpp"

namespace hotfire::explain {

/// "rms", "max", "bias" in the channel's unit and "fit_percent".
nlohmann::json errors_of(const ChannelFit& fit);

/// How the declared, the calibrated and the explained model do on records that were kept back whole: no fit and no choice
/// has seen a row of them. The explained model is the one of explained.toml. A force-driven mass starts as the first rows
/// say, a sinusoid of unknown law at the phase of the record's own clock. `held_out_records` of docs/report.md. Throws
/// FileError as `make_dataset`.
template <class Family>
nlohmann::json held_out_records_json(const ModelFile& model, const std::vector<Record>& kept_back,
                                     const SearchResult<Family>& found, unsigned threads);

/// The same of one record and what three models predict of it, by name of the stage: "before", "calibrated", "after". `data`
/// holds this record alone.
nlohmann::json held_out_record_json(const Record& record, const Dataset& data,
                                    const std::vector<std::pair<const char*, Prediction>>& stages);

}  // namespace hotfire::explain
