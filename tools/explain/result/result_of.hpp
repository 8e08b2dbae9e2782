// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/result/result.hpp"
#include "tools/explain/search/search.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::explain {

/// The result of a search. The caller adds held-out records, baseline, next experiment and valve bias.
Result result_of(const ModelFile& model, const std::vector<Record>& records, const Dataset& data, const SearchResult& found);

/// Appends warnings about the rows that are simulated and not compared.
void warn_of_rows(const Dataset& data, std::vector<std::string>& warnings);

}  // namespace hotfire::explain
