// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/search/search.hpp"
#include "tools/report/report_page.hpp"

namespace hotfire::explain {

// What every explanation ends with, of one axis or of several.

/// What the page draws of one search.
ReportSeries series_of(const std::vector<Record>& records, const Dataset& data, const SearchResult& found);

/// The explained model as a rig runs it: what is a fault of the records and not of the plant is left out. What drifted over
/// the time of a record is set to its mean, since another run has another clock, or left out if it has none; unless
/// `keep_drift`.
ModelParameters plant_of(const SearchResult& found, bool keep_drift);

/// The explained model fitted once more, to the rows that were held out as well: what the rig runs has seen all that there
/// is, its tables reaching over them, with the intervals that its profile gives. The errors of `found` stay those of the fit
/// that had not seen them.
void fit_to_all_rows(Dataset data, unsigned threads, SearchResult& found);

}  // namespace hotfire::explain
