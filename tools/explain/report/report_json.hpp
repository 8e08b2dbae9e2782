// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/explain/search/search.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::explain {

/// report.json (docs/report.md) of a search, without the keys that only the caller knows (command line, seconds, version).
template <class Family>
nlohmann::json report_json(const ModelFile& model, const std::vector<Record>& records, const Dataset& data,
                           const SearchResult<Family>& found);

/// Noise and zero of each channel of one record, in the channel's unit.
nlohmann::json record_channels_json(const Dataset& data, std::size_t experiment, const Zeros& zeros);

/// Warnings of the rows that are simulated and not compared.
void warn_of_rows(const Dataset& data, nlohmann::json& warnings);

extern template nlohmann::json report_json(const ModelFile&, const std::vector<Record>&, const Dataset&,
                                           const SearchResult<SimplexFamily>&);
extern template nlohmann::json report_json(const ModelFile&, const std::vector<Record>&, const Dataset&,
                                           const SearchResult<DirectFamily>&);

}  // namespace hotfire::explain
